//! Trajectories as other programs and people write them: frames of their own, other orders, units and separators.

use std::fmt::Write;
use std::path::Path;

use crate::common::program::{run_in, stderr};
use crate::common::tracks::{file, measured, options, read_as};
use crate::common::vector;
use rusqlite::Connection;
use sandbox::analysis::crossing::Line;
use sandbox::lab::measure::{Options, Site};
use sandbox::scenario::trajectories::{OnLevel, ReadOptions, Tracks, Unit, read};

const PLAIN: ReadOptions = ReadOptions {
    unit: None,
    fps: None,
    level: OnLevel::Only,
};
/// How fast all people walk along x, m/s, from 0 to 5 m.
const SPEED: f64 = 1.25;
/// How long after the one before a person begins, seconds.
const APART: f64 = 0.8;
/// Where the line is that people cross, m.
const LINE: f64 = 2.53;

/// A row: id, frame, and x and y in meters.
type Row = (i64, i64, f64, f64);

/// The rows of `count` people from the frame in which each begins until 5 m, `step` frames apart.
fn walk(count: i64, fps: f64, step: i64, phase: impl Fn(i64) -> i64) -> Vec<Row> {
    let mut rows = Vec::new();
    for id in 1..=count {
        let first = ((id - 1) as f64 * APART * fps).round() as i64 + phase(id);
        for k in 0..=(5.0 / SPEED * fps / step as f64).floor() as i64 {
            let x = SPEED * (k * step) as f64 / fps;
            rows.push((id, first + k * step, x, 0.5 + 0.5 * (id % 2) as f64));
        }
    }
    rows
}

/// The text of rows, each written by `row`.
fn text(header: &str, rows: &[Row], row: impl Fn(&Row) -> String) -> String {
    let mut text = header.to_owned();
    rows.iter()
        .for_each(|one| writeln!(text, "{}", row(one)).unwrap());
    text
}

/// The row as id, frame, x, y.
fn usual((id, frame, x, y): &Row) -> String {
    format!("{id} {frame} {x:.4} {y}")
}

/// The number of people, the passages of the line, and the mean speed.
fn found(tracks: &Tracks) -> (usize, usize, f64) {
    let line = Line {
        start: vector(LINE, 3.0),
        end: vector(LINE, -1.0),
    };
    let options = Options {
        lines: vec![line],
        ..options()
    };
    let (measured, _) = measured(tracks, &Site::new(Vec::new()), &options);
    let passages = measured.crossings[0].list.iter().filter(|one| one.passage);
    let speed = measured.overview.speed.mean;
    (tracks.ids.len(), passages.count(), speed)
}

/// Checks that all of `count` people cross the line at their speed.
fn check(tracks: &Tracks, count: i64) {
    let (people, passages, speed) = found(tracks);
    assert_eq!((people, passages), (count as usize, count as usize));
    assert!((speed / SPEED - 1.0).abs() < 1e-3, "{speed}");
}

/// The largest number of people at a time, by the rows' frames.
fn most_at_once(rows: &[Row]) -> usize {
    let ends = |id: i64| {
        let own = rows.iter().filter(|row| row.0 == id).map(|row| row.1);
        (own.clone().min().unwrap(), own.max().unwrap())
    };
    let people: Vec<(i64, i64)> = (1..=rows.last().unwrap().0).map(ends).collect();
    let at = |frame: i64| {
        people
            .iter()
            .filter(|(a, b)| (*a..=*b).contains(&frame))
            .count()
    };
    rows.iter().map(|row| at(row.1)).max().unwrap()
}

#[test]
fn people_may_have_frames_of_their_own() {
    for (fps, step) in [(25.0, 10), (15.0, 6), (30.0, 12)] {
        let rows = walk(20, fps, step, |id| (7 * id) % step);
        let header = format!("# framerate: {fps}\n# id frame x/m y/m\n");
        let tracks = read_as("a.txt", &text(&header, &rows, usual), &PLAIN).unwrap();
        assert_eq!(tracks.step, step);
        assert!(
            !tracks.notes.iter().any(|note| note.contains("gap")),
            "{:?}",
            tracks.notes
        );
        check(&tracks, 20);
        // All people who are there are in each frame, where they are at that time.
        let common = tracks.together();
        let shown = (0..common.frames.len()).map(|k| common.rows(k).len()).max();
        assert!(shown >= Some(most_at_once(&rows) - 1), "{shown:?}");
        for (k, &frame) in common.frames.iter().enumerate() {
            for row in common.rows(k) {
                let p = common.person[row] as usize;
                let place = tracks.place_at(p, common.time(frame));
                assert!((common.position[row] - place).norm() < 1e-9);
            }
        }
    }
}

#[test]
fn late_rows_are_no_gaps_and_missing_rows_are() {
    let mut rows = walk(3, 25.0, 5, |_| 0);
    rows[7].1 += 1;
    rows[7].2 += SPEED / 25.0;
    let header = "# framerate: 25\n# id frame x/m y/m\n";
    let tracks = read_as("a.txt", &text(header, &rows, usual), &PLAIN).unwrap();
    assert!(
        !tracks.notes.iter().any(|note| note.contains("gap")),
        "{:?}",
        tracks.notes
    );
    check(&tracks, 3);
    rows.remove(9);
    let tracks = read_as("a.txt", &text(header, &rows, usual), &PLAIN).unwrap();
    assert!(
        tracks.notes.iter().any(|note| note.starts_with("1 gap(s)")),
        "{:?}",
        tracks.notes
    );
}

#[test]
fn pictures_and_pages_show_all_people_of_a_moment() {
    let rows = walk(20, 25.0, 10, |id| (3 * id) % 10);
    let header = "# framerate: 25\n# id frame x/m y/m\n";
    let (folder, _) = file("a.txt", &text(header, &rows, usual));
    for secs in ["5", "9", "12.2"] {
        let output = run_in(
            folder.path(),
            &["draw", "a.txt", "--at", secs, "-o", "a.svg", "--force"],
        );
        let said = String::from_utf8(output.stdout).unwrap();
        let is_all = said.contains(" 5 agents") || said.contains(" 6 agents");
        assert!(is_all, "{said}{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn frames_before_ids_are_told_by_the_ways_of_people() {
    let frame_first = |(id, frame, x, y): &Row| format!("{frame}.0\t{id}.0\t{x:.2}\t{y:.2}");
    let eight = |row: &Row| format!("{} 1.7 0 0 0", frame_first(row));
    let rows = walk(20, 25.0, 10, |_| 0);
    for unit in [None, Some(Unit::Meter)] {
        let options = ReadOptions {
            unit,
            fps: Some(25.0),
            ..PLAIN
        };
        for text in [text("", &rows, frame_first), text("", &rows, eight)] {
            let tracks = read_as("a.txt", &text, &options).unwrap();
            check(&tracks, 20);
            let note = "its columns are taken as frame, id, x, y: people walk at 1.25 m/s then";
            assert!(
                tracks.notes.iter().any(|one| one.starts_with(note)),
                "{:?}",
                tracks.notes
            );
        }
        // Ids come first as usual, also with sparse ids and in centimeters without a unit.
        for (factor, ids) in [(1.0, 1), (1.0, 1000), (100.0, 1000), (100.0, 1)] {
            let usual = |(id, frame, x, y): &Row| {
                format!("{} {frame} {:.2} {}", id * ids, x * factor, y * factor)
            };
            let tracks = read_as("a.txt", &text("", &rows, usual), &options).unwrap();
            assert_eq!(tracks.ids.len(), 20);
        }
    }
}

#[test]
fn obsmat_is_read_with_its_frame_rate() {
    let row = |(id, frame, x, y): &Row| {
        format!(
            "{frame:.7e} {id:.7e} {x:.7e} 0.0 {:.7e} {SPEED:.7e} 0.0 {:.7e}",
            y + 0.2 * x,
            0.2 * SPEED
        )
    };
    for (fps, step) in [(15.0, 6), (25.0, 10)] {
        let rows = walk(12, fps, step, |id| (5 * id) % step);
        let tracks = read_as("obsmat.txt", &text("", &rows, row), &PLAIN).unwrap();
        assert_eq!(
            (tracks.fps, tracks.unit, tracks.step),
            (fps, Some(Unit::Meter), step)
        );
        let (people, passages, speed) = found(&tracks);
        assert_eq!((people, passages), (12, 12));
        assert!((speed - SPEED * 1.04_f64.sqrt()).abs() < 1e-3, "{speed}");
    }
}

#[test]
fn an_id_that_is_used_again_is_another_person() {
    // Person 1 walks 5 m, and at once again from 0 on; person 2 walks slowly.
    let mut rows = walk(1, 10.0, 1, |_| 0);
    let again: Vec<Row> = rows
        .iter()
        .map(|&(id, frame, x, y)| (id, frame + 41, x, y))
        .collect();
    rows.extend(again);
    rows.extend((0..=100).map(|frame| (2, frame, 0.05 * frame as f64, 0.5)));
    let header = "# framerate: 10\n# id frame x/m y/m\n";
    let tracks = read_as("a.txt", &text(header, &rows, usual), &PLAIN).unwrap();
    let (people, passages, speed) = found(&tracks);
    assert_eq!((people, passages, &tracks.ids), (3, 3, &vec![1, 2, 3]));
    let mean = (82.0 * SPEED + 101.0 * 0.5) / 183.0;
    assert!((speed - mean).abs() < 1e-3, "{speed}");
    let note =
        "1 jump(s) that no person makes, the first by person 1 by 5.00 m from 4.00 to 4.10 s";
    assert!(tracks.notes[0].starts_with(note), "{:?}", tracks.notes);
}

#[test]
fn wrong_units_are_told_with_the_one_that_fits() {
    let rows = walk(5, 25.0, 1, |_| 0);
    let millimeters =
        |(id, frame, x, y): &Row| format!("{id} {frame} {:.0} {:.0}", 1000.0 * x, 1000.0 * y);
    let plain = text("# framerate: 25\n", &rows, millimeters);
    for (unit, speed) in [
        (None, "1250 m/s, 962"),
        (Some(Unit::Centimeter), "12.5 m/s, 9.62"),
    ] {
        let notes = read_as("a.txt", &plain, &ReadOptions { unit, ..PLAIN })
            .unwrap()
            .notes;
        let note = format!(
            "half of all steps are faster than {speed} times as fast as people walk: with --unit mm it is 1.25 m/s"
        );
        assert!(notes.contains(&note), "{notes:?}");
    }
    let unit = Some(Unit::Millimeter);
    check(
        &read_as("a.txt", &plain, &ReadOptions { unit, ..PLAIN }).unwrap(),
        5,
    );
    for header in [
        "# id frame x/mm y/mm\n",
        "id frame x[mm] y[mm]\n",
        "# in mm\n",
    ] {
        let text = text(&format!("# framerate: 25\n{header}"), &rows, millimeters);
        let tracks = read_as("a.txt", &text, &PLAIN).unwrap();
        assert!(tracks.notes.is_empty(), "{:?}", tracks.notes);
        check(&tracks, 5);
    }
    let feet = |(id, frame, x, y): &Row| {
        format!(
            "{id},{frame},{},{:.6},{y}",
            *frame as f64 / 25.0,
            x / 0.3048
        )
    };
    let tracks = read_as(
        "a.csv",
        &text("id,frame,time,x[ft],y[ft]\n", &rows, feet),
        &PLAIN,
    );
    check(&tracks.unwrap(), 5);
}

#[test]
fn databases_may_have_frames_and_ids_as_floating_point_numbers() {
    let (_folder, path) = file("a.sqlite", "");
    let connection = Connection::open(&path).unwrap();
    let values = walk(4, 25.0, 2, |_| 0);
    let values = values
        .iter()
        .map(|(id, frame, x, y)| format!("({frame}.0, {id}.0, {x}, {y})"));
    let rows = values.collect::<Vec<_>>().join(", ");
    let tables = format!(
        "CREATE TABLE metadata (key TEXT, value TEXT);
         CREATE TABLE trajectory_data (frame REAL, id REAL, pos_x REAL, pos_y REAL);
         INSERT INTO metadata VALUES ('fps', '25.0');
         INSERT INTO trajectory_data VALUES {rows};"
    );
    connection.execute_batch(&tables).unwrap();
    check(&read(&path, &PLAIN).unwrap(), 4);
    let half = "INSERT INTO trajectory_data VALUES (0.5, 1, 0, 0)";
    connection.execute_batch(half).unwrap();
    let said = read(&path, &PLAIN).unwrap_err().to_string();
    assert!(said.ends_with("frame is not a whole number"), "{said}");
}

#[test]
fn semicolons_and_decimal_commas_are_read() {
    let rows = walk(5, 25.0, 1, |_| 0);
    let german = |row: &Row| {
        let (id, frame, x, y) = row;
        format!("{id};{frame};{:.2};{x:.4};{y:.1}", *frame as f64 / 25.0).replace('.', ",")
    };
    let tabs = |row: &Row| usual(row).replace(' ', "\t").replace('.', ",");
    for (name, text) in [
        ("a.csv", text("id;frame;time;x[m];y[m]\n", &rows, german)),
        ("a.txt", text("id;frame;time;x[m];y[m]\n", &rows, german)),
        (
            "a.csv",
            text("# framerate: 25\nid\tframe\tx/m\ty/m\n", &rows, tabs),
        ),
        (
            "a.txt",
            text("# framerate: 25\n# id frame x/m y/m\n", &rows, tabs),
        ),
    ] {
        let tracks = read_as(name, &text, &PLAIN).unwrap();
        assert_eq!(tracks.fps, 25.0);
        check(&tracks, 5);
    }
}

#[test]
fn times_number_the_frames_of_pathfinder_and_viswalk() {
    for (fps, start, digits) in [
        (12.5, 0.0, 6),
        (30.0, 0.0, 2),
        (5.0, 3600.4, 1),
        (10.0, 0.05, 2),
    ] {
        let rows = walk(4, fps, 1, |_| 0);
        let time = |frame: &i64| format!("{:.digits$}", start + *frame as f64 / fps);
        let pathfinder = text(
            "\"t\",\"id\",\"name\",\"x\",\"y\",\"z\"\n\"s\",\"\",\"\",\"m\",\"m\",\"m\"\n",
            &rows,
            |(id, frame, x, y)| format!("{},{id},\"0{id}\",{x:.6},{y:.6},0.02", time(frame)),
        );
        let viswalk = text(
            "$VISION\n* File: a.inpx\n*\n* Table: Pedestrians In Network\n*\n\
             \u{feff}$PEDESTRIAN:NO;SIMSEC;COORDCENTX;COORDCENTY;SPEED\n",
            &rows,
            |(id, frame, x, y)| format!("{id};{};{x:.6};{y:.6};4.5", time(frame)),
        );
        for (name, text) in [("a.csv", pathfinder), ("a.pp", viswalk)] {
            let tracks = read_as(name, &text, &PLAIN).unwrap();
            assert!(
                (tracks.fps / fps - 1.0).abs() < 1e-6,
                "{} for {fps}",
                tracks.fps
            );
            assert!((tracks.time(tracks.frames[0]) - start).abs() <= 0.5 / fps);
            assert!(tracks.notes.is_empty(), "{:?}", tracks.notes);
            check(&tracks, 4);
        }
    }
    // Times that people do not have in common.
    let rows = walk(9, 1000.0, 400, |id| (137 * id) % 400);
    let text = text("id,time,x/m,y/m\n", &rows, |(id, frame, x, y)| {
        format!("{id},{:.3},{x},{y}", *frame as f64 / 1000.0)
    });
    check(&read_as("a.csv", &text, &PLAIN).unwrap(), 9);
}

/// UTF-16 with a byte-order mark.
fn utf16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    let marked = format!("\u{feff}{text}");
    marked.encode_utf16().flat_map(bytes).collect()
}

#[test]
fn scenarios_plans_and_trajectories_may_be_utf16() {
    let rows = walk(4, 25.0, 2, |_| 0);
    let walkers = text(
        "# framerate: 25\n# id frame x/m y/m \u{1f6b6}\n",
        &rows,
        usual,
    );
    let table = text("id,time,x/m,y/m\n", &rows, |(id, frame, x, y)| {
        format!("{id},{},{x},{y}", *frame as f64 / 25.0)
    });
    let plan = "POLYGON ((-1 -1, 9 -1, 9 9, -1 9, -1 -1))";
    let scenario = r#"{"walkable_area": "a.wkt", "goal": [8, 8], "duration_secs": 0,
                       "from": {"trajectory": "a.txt"}}"#;
    for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), utf16(text, bytes)).unwrap();
        };
        write("a.txt", &walkers);
        write("a.csv", &table);
        write("a.wkt", plan);
        write("a.json", scenario);
        check(&read(&folder.path().join("a.txt"), &PLAIN).unwrap(), 4);
        check(&read(&folder.path().join("a.csv"), &PLAIN).unwrap(), 4);
        succeeds(folder.path(), &["run", "a.json"]);
    }
    let path = tempfile::tempdir().unwrap().keep().join("a.txt");
    let broken = [utf16("1 2 3 4\n", u16::to_le_bytes), vec![0x31]].concat();
    std::fs::write(&path, broken).unwrap();
    let said = read(&path, &PLAIN).unwrap_err().to_string();
    assert!(said.contains("UTF-16 text ends within a letter"), "{said}");
}

fn succeeds(folder: &Path, arguments: &[&str]) {
    let output = run_in(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn advice_on_a_missing_frame_rate_names_the_option_of_the_command() {
    let (folder, _) = file(
        "a.txt",
        &text("# id frame x/m y/m\n", &walk(2, 25.0, 1, |_| 0), usual),
    );
    for (arguments, option) in [
        (&["measure", "a.txt"][..], "--fps"),
        (&["compare", "a.txt", "a.txt"], "--fps"),
        (&["page", "a.txt"], "--trajectory-fps"),
        (&["draw", "a.txt"], "--trajectory-fps"),
        (&["draw", "a.txt", "--egress"], "--trajectory-fps"),
    ] {
        let arguments = [arguments, &["--force"]].concat();
        let said = stderr(&run_in(folder.path(), &arguments));
        assert!(
            said.trim_end().ends_with(&format!("; give {option}")),
            "{said}"
        );
        let given = [arguments, vec![option, "25"]].concat();
        succeeds(folder.path(), &given);
    }
}
