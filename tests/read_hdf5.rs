//! Trajectories in HDF5 as the Pedestrian Dynamics Data Archive has them, valid and broken.

use std::fs;

use crate::common::program::{refused, run_json};
use crate::common::vector;
use hdf5_pure::{AttrValue, CompoundTypeBuilder, Datatype, FileBuilder};
use sandbox::scenario::trajectories::{OnLevel, ReadOptions, Tracks, read};

const PLAIN: ReadOptions = ReadOptions {
    unit: None,
    fps: None,
    level: OnLevel::Only,
};

const PLAN: &str = "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))";

/// The field names and bytes of a file.
struct Records {
    datatype: Datatype,
    bytes: Vec<u8>,
    count: u64,
}

/// Rows of id, frame, x and y, with 64 bits each.
fn wide(rows: &[(i64, i64, f64, f64)]) -> Records {
    let datatype = CompoundTypeBuilder::new()
        .i64_field("id")
        .i64_field("frame")
        .f64_field("x")
        .f64_field("y");
    let row = |&(id, frame, x, y): &(i64, i64, f64, f64)| {
        let whole = [id, frame].map(i64::to_le_bytes);
        [whole, [x, y].map(f64::to_le_bytes)].concat().concat()
    };
    Records {
        datatype: datatype.build().unwrap(),
        bytes: rows.iter().flat_map(row).collect(),
        count: rows.len() as u64,
    }
}

/// A file of these records.
fn written(records: &Records, fps: Option<f64>) -> Vec<u8> {
    let mut file = FileBuilder::new();
    let dataset = file.create_dataset("trajectory").with_compound_data(
        records.datatype.clone(),
        records.bytes.clone(),
        records.count,
    );
    if let Some(fps) = fps {
        dataset.set_attr("fps", AttrValue::F64(fps));
    }
    file.set_attr("wkt_geometry", AttrValue::String(PLAN.to_owned()));
    file.finish().unwrap()
}

/// Reads a file of these records; the folder is removed from error messages.
fn read_records(records: &Records, fps: Option<f64>) -> Result<Tracks, String> {
    read_bytes(&written(records, fps))
}

fn read_bytes(bytes: &[u8]) -> Result<Tracks, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    fs::write(&path, bytes).unwrap();
    let folder = format!("{}/", folder.path().display());
    read(&path, &PLAIN).map_err(|error| error.to_string().replace(&folder, ""))
}

#[test]
fn records_frame_rate_and_walkable_area_are_read() {
    let rows = [(7, -1, 1.5, 2.5), (3, -1, 0.25, 4.0), (7, 0, 1.75, 2.5)];
    let tracks = read_records(&wide(&rows), Some(12.5)).unwrap();
    assert_eq!((tracks.fps, tracks.len()), (12.5, 3));
    assert_eq!(
        (tracks.ids.as_slice(), tracks.frames.as_slice()),
        (&[3, 7][..], &[-1, 0][..])
    );
    assert_eq!(tracks.position[0], vector(0.25, 4.0));
    assert_eq!(tracks.walkable, [PLAN]);
    assert!(tracks.notes.is_empty(), "{:?}", tracks.notes);
}

#[test]
fn people_are_drawn_and_have_no_other_columns() {
    let folder = tempfile::tempdir().unwrap();
    let [file, picture] = ["run.hdf5", "run.png"].map(|name| folder.path().join(name));
    let rows = wide(&[(7, 0, 1.5, 2.5), (3, 0, 0.25, 4.0), (7, 1, 1.75, 2.5)]);
    fs::write(&file, written(&rows, Some(12.5))).unwrap();
    let [file, picture] = [&file, &picture].map(|path| path.to_str().unwrap());
    let drawn = run_json(&["draw", file, "--out", picture, "--json"]);
    assert_eq!(drawn["agents"], 2);
    let colored = ["draw", file, "--out", picture, "--force", "--color", "lean"];
    refused(&colored, 2, &["lean"]);
}

#[test]
fn narrow_fields_in_any_order_are_read() {
    let datatype = CompoundTypeBuilder::new()
        .f32_field("y")
        .f32_field("x")
        .i32_field("frame")
        .u8_field("id");
    let mut bytes = Vec::new();
    for (id, frame, x, y) in [(200_u8, -3_i32, 0.5_f32, -1.5_f32), (1, 4, 2.0, 3.0)] {
        bytes.extend([y.to_le_bytes(), x.to_le_bytes(), frame.to_le_bytes()].concat());
        bytes.push(id);
    }
    let records = Records {
        datatype: datatype.build().unwrap(),
        bytes,
        count: 2,
    };
    let tracks = read_records(&records, Some(25.0)).unwrap();
    assert_eq!(
        (tracks.ids.as_slice(), tracks.frames.as_slice()),
        (&[1, 200][..], &[-3, 4][..])
    );
    assert_eq!(tracks.position, [vector(0.5, -1.5), vector(2.0, 3.0)]);
}

#[test]
fn broken_files_are_refused_with_what_is_wrong() {
    let nan = wide(&[(1, 0, 1.0, 1.0), (1, 1, f64::NAN, 1.0)]);
    let said = |result: Result<Tracks, String>| result.unwrap_err();
    assert_eq!(
        said(read_records(&nan, Some(25.0))),
        "run.h5: row 2: x is not a finite number"
    );
    let one = wide(&[(1, 0, 1.0, 1.0)]);
    assert!(said(read_records(&one, None)).contains("give --fps"));
    assert!(said(read_records(&one, Some(-1.0))).contains("attribute fps of `trajectory`"));
    let lacking = Records {
        datatype: CompoundTypeBuilder::new()
            .i64_field("id")
            .f64_field("x")
            .build()
            .unwrap(),
        bytes: vec![0; 16],
        count: 1,
    };
    let words = "the records of `trajectory` have no field frame, only";
    assert!(said(read_records(&lacking, Some(25.0))).contains(words));
    let mut other = FileBuilder::new();
    other.create_dataset("positions").with_f64_data(&[1.0]);
    let words = "no dataset `trajectory`";
    assert!(said(read_bytes(&other.finish().unwrap())).contains(words));
    let mut list = FileBuilder::new();
    list.create_dataset("trajectory").with_f64_data(&[1.0]);
    assert!(said(read_bytes(&list.finish().unwrap())).contains("not a list of records"));
}

#[test]
fn a_file_cut_or_changed_anywhere_is_read_or_refused() {
    let rows: Vec<_> = (0..20).map(|k| (k % 4, k / 4, k as f64, 1.0)).collect();
    let records = wide(&rows);
    let mut file = FileBuilder::new();
    let dataset = file.create_dataset("trajectory").with_compound_data(
        records.datatype,
        records.bytes,
        records.count,
    );
    dataset.set_attr("fps", AttrValue::F64(25.0));
    let whole = file.finish().unwrap();
    assert_eq!(read_bytes(&whole).unwrap().len(), 20);
    for at in 0..whole.len() {
        let said = |result: Result<Tracks, String>| {
            result.is_err_and(|said| !said.starts_with("run.h5") || said.contains(char::is_control))
        };
        assert!(!said(read_bytes(&whole[..at])), "cut at {at}");
        let mut changed = whole.clone();
        changed[at] ^= 0x55;
        assert!(!said(read_bytes(&changed)), "changed at {at}");
    }
}
