//! Reading and measuring any trajectory file gives finite numbers or an error, within bounded memory.
//!
//! 100,000 texts and 6,500 databases; more with `BAD_INPUT_TIMES=10 cargo test …`. The memory limit is 4 MB plus
//! 300 bytes per byte of the file, and twice that for databases.

use std::fs::{self, File};
use std::io::Read;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::common::bounded::cases;
use crate::common::reading_trajectories::{judge, read};
use crate::common::tracks::file;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use rusqlite::Connection;
use sandbox::scenario::trajectories::{ReadOptions, read as read_file, read_text};

fn memory_limit(bytes: usize) -> u64 {
    (4 << 20) + 300 * bytes as u64
}

/// Checks that enough of the generated files are valid.
fn assert_some(rows_read: AtomicU64) {
    let rows = rows_read.into_inner();
    assert!(rows > 1_000, "{rows} rows were read");
}

/// Cells that are invalid in many places.
const INVALID: [&str; 26] = [
    "",
    "0",
    "-0",
    "-1",
    "1e-300",
    "1e300",
    "-1e300",
    "1e9",
    "1.1e9",
    "NaN",
    "inf",
    "-inf",
    "5e-324",
    "0.5",
    "9223372036854775807",
    "-9223372036854775808",
    "9007199254740992",
    "-9007199254740992",
    "9007199254740993",
    "1e400",
    "0x10",
    "x",
    "\u{1b}[31m",
    "\"",
    "é",
    "#",
];

/// A whole number for an id or a frame, or rarely something else.
fn whole() -> impl Strategy<Value = String> {
    prop_oneof![
        20 => (-3..9_i64).prop_map(|n| n.to_string()),
        1 => select(INVALID.to_vec()).prop_map(str::to_owned),
        1 => any::<i64>().prop_map(|n| n.to_string()),
    ]
}

fn coordinate() -> impl Strategy<Value = String> {
    prop_oneof![
        20 => (-5.0..5.0_f64).prop_map(|x| x.to_string()),
        1 => select(INVALID.to_vec()).prop_map(str::to_owned),
        1 => any::<f64>().prop_map(|x| format!("{x:e}")),
    ]
}

/// Rows of id, frame, x, y and one more column.
fn rows() -> impl Strategy<Value = Vec<[String; 5]>> {
    let row = (whole(), whole(), coordinate(), coordinate(), coordinate());
    let row = row.prop_map(|(id, frame, x, y, more)| [id, frame, x, y, more]);
    prop::collection::vec(row, 0..8)
}

/// A way to damage a text.
fn damage() -> impl Strategy<Value = (u8, [Index; 2], u8)> {
    (0..12_u8, any::<[Index; 2]>(), any::<u8>())
}

fn damaged(mut bytes: Vec<u8>, (how, places, by): (u8, [Index; 2], u8)) -> Vec<u8> {
    if bytes.is_empty() {
        return bytes;
    }
    let [from, to] = places.map(|place| place.index(bytes.len()));
    match how {
        0 => bytes.truncate(from),
        1 => bytes[from] = by,
        2 => bytes[from] ^= 1 << (by % 8),
        3 => drop(bytes.drain(from.min(to)..from.max(to))),
        4 => bytes.extend_from_within(from.min(to)..from.max(to)),
        _ => {}
    }
    bytes
}

#[test]
fn any_bytes_are_read_or_refused() {
    let bytes = || prop::collection::vec(any::<u8>(), 0..200);
    let name = || select(vec!["a.txt", "a.csv"]);
    cases(
        30_000,
        || (bytes(), name()),
        |(bytes, name)| {
            read(name, &bytes);
            memory_limit(bytes.len())
        },
    );
}

#[test]
fn texts_with_changed_values_are_read_or_refused() {
    let rows_read = AtomicU64::new(0);
    let rate = || {
        let comments = ["# framerate: ", "#frame rate=", "# Framerate [1/s] "];
        (
            select(comments.to_vec()),
            prop_oneof![3 => Just("10".to_owned()), 1 => whole()],
        )
    };
    let heads = [
        "",
        "# id frame x/m y/m z/m\n",
        "# id frame x/cm y/cm mass\n",
        "# frame id y x\n",
        "# x and y in cm\n",
        "# id frame x/mm y\n",
        "id fr x [m]\n",
    ];
    let head = || select(heads.to_vec());
    let separator = || select(vec![" ", "\t", "  ", ","]);
    let input = || (rate(), head(), rows(), separator(), damage());
    cases(
        35_000,
        input,
        |((comment, rate), head, rows, separator, damage)| {
            let rows = rows.iter().map(|row| row.join(separator) + "\n");
            let text = format!("{comment}{rate}\n{head}{}", rows.collect::<String>());
            let bytes = damaged(text.into_bytes(), damage);
            rows_read.fetch_add(read("a.txt", &bytes), Relaxed);
            memory_limit(bytes.len())
        },
    );
    assert_some(rows_read);
}

#[test]
fn tables_with_changed_values_are_read_or_refused() {
    let rows_read = AtomicU64::new(0);
    let heads = [
        "id,frame,pos_x,pos_y,time",
        "id,frame,x,y,mass",
        "\"id\",\"frame\",\"x\",\"y\",\"time\"",
        "frame,id,x/cm,y/cm,time",
        "id,frame,x",
        "time,id,frame,x,y",
        "id,id,id,id,id",
    ];
    let head = || select(heads.to_vec());
    cases(
        35_000,
        || (head(), rows(), damage()),
        |(head, rows, damage)| {
            let rows = rows.iter().map(|row| row.join(",") + "\n");
            let text = format!("{head}\n{}", rows.collect::<String>());
            let bytes = damaged(text.into_bytes(), damage);
            rows_read.fetch_add(read("a.csv", &bytes), Relaxed);
            memory_limit(bytes.len())
        },
    );
    assert_some(rows_read);
}

/// Writes a JuPedSim database with pages of 512 bytes and three rows.
fn database(path: &Path) {
    let connection = Connection::open(path).unwrap();
    connection
        .execute_batch(
            "PRAGMA page_size = 512;
             CREATE TABLE trajectory_data (frame INTEGER, id INTEGER, pos_x REAL, pos_y REAL, mass);
             CREATE TABLE metadata (key TEXT, value TEXT);
             CREATE TABLE geometry (wkt TEXT);
             INSERT INTO metadata VALUES ('fps', '12.5');
             INSERT INTO geometry VALUES ('POLYGON ((0 0, 9 0, 9 9, 0 0))');
             INSERT INTO trajectory_data VALUES (0, 7, 2, 1, 1), (1, 7, 2.5, 1, 1), (1, 8, 1, 1, 1);",
        )
        .unwrap();
}

/// Only 5,000 cases, because SQLite opens, locks and reads a file in each. One small file is damaged and restored
/// each time.
#[test]
fn databases_with_changed_bytes_are_read_or_refused() {
    let rows_read = AtomicU64::new(0);
    let (_folder, path) = file("a.sqlite", "");
    database(&path);
    let whole = fs::read(&path).unwrap();
    let disk = File::options().write(true).open(&path).unwrap();
    let name = path.display().to_string();
    let changes = || prop::collection::vec((any::<Index>(), any::<u8>()), 1..4);
    let cut = || prop::option::weighted(0.1, any::<Index>());
    cases(
        5_000,
        || (changes(), cut()),
        |(changes, cut)| {
            for (place, by) in &changes {
                let at = place.index(whole.len() - 16) + 16; // keep the magic number
                disk.write_all_at(&[*by], at as u64).unwrap();
            }
            if let Some(cut) = cut {
                disk.set_len(cut.index(whole.len()) as u64).unwrap();
            }
            rows_read.fetch_add(
                judge(&name, read_file(&path, &ReadOptions::default())),
                Relaxed,
            );
            disk.write_all_at(&whole, 0).unwrap();
            disk.set_len(whole.len() as u64).unwrap();
            2 * memory_limit(whole.len())
        },
    );
    assert_eq!(read_file(&path, &ReadOptions::default()).unwrap().len(), 3);
    assert_some(rows_read);
}

/// Only 1,500 cases, because each takes a transaction.
#[test]
fn databases_with_changed_values_are_read_or_refused() {
    let rows_read = AtomicU64::new(0);
    let values = [
        "0",
        "1",
        "2.5",
        "-1",
        "NULL",
        "'a'",
        "x'00ff'",
        "1e300",
        "-1e300",
        "9e999",
        "9223372036854775807",
        "-9223372036854775808",
        "9007199254740992",
    ];
    let (_folder, path) = file("a.sqlite", "");
    database(&path);
    let connection = Connection::open(&path).unwrap();
    connection
        .execute_batch("PRAGMA synchronous = OFF")
        .unwrap();
    let connection = Mutex::new(connection); // a case may run on any thread
    let name = path.display().to_string();
    let number = || (0..12_i64).prop_map(|n| n.to_string());
    let other = || select(values.to_vec()).prop_map(str::to_owned);
    let value = || prop_oneof![30 => number(), 1 => other()];
    let row = || prop::collection::vec(value(), 5);
    let rates = ["'1e-300'", "0", "-1", "NULL", "'x'", "1e7", "16"];
    let rate = || prop_oneof![4 => Just("'10'"), 1 => select(rates.to_vec())];
    cases(
        1_500,
        || (prop::collection::vec(row(), 1..5), rate()),
        |(rows, rate)| {
            let rows: Vec<String> = rows
                .iter()
                .map(|row| format!("({})", row.join(",")))
                .collect();
            let change = format!(
                "BEGIN; DELETE FROM trajectory_data; UPDATE metadata SET value = {rate};
             INSERT INTO trajectory_data VALUES {}; COMMIT;",
                rows.join(",")
            );
            connection.lock().unwrap().execute_batch(&change).unwrap();
            rows_read.fetch_add(
                judge(&name, read_file(&path, &ReadOptions::default())),
                Relaxed,
            );
            2 * memory_limit(4096)
        },
    );
    assert_some(rows_read);
}

#[test]
fn an_endless_line_is_refused_in_little_memory() {
    for (name, byte) in [
        ("a.txt", b'1'),
        ("a.txt", b' '),
        ("a.csv", b','),
        ("a.csv", b'"'),
        ("a.txt", b'#'),
    ] {
        let head = b"id,frame,x,y\n1,0,0,0\n".repeat(usize::from(name == "a.csv"));
        let endless = head.as_slice().chain(std::io::repeat(byte)).take(1 << 28);
        let mut said = String::new();
        let held = allocation_counter::measure(|| {
            let read = read_text(Path::new(name), endless, &ReadOptions::default());
            said = read.unwrap_err().to_string();
        });
        let line = if name == "a.csv" { 3 } else { 1 };
        let start = format!("{name}:{line}: ");
        assert!(
            said.starts_with(&start) && said.ends_with("the line is longer than 1048576 bytes"),
            "{said}"
        );
        assert!(
            held.bytes_max < 40 << 20,
            "{byte}: {} bytes",
            held.bytes_max
        );
    }
}

#[test]
fn a_table_that_is_an_endless_view_is_refused() {
    let (_folder, path) = file("a.sqlite", "");
    let connection = Connection::open(&path).unwrap();
    let view = "CREATE VIEW trajectory_data AS WITH RECURSIVE n(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM n)
                SELECT k AS frame, 1 AS id, 0.0 AS pos_x, 0.0 AS pos_y FROM n";
    connection.execute_batch(view).unwrap();
    let said = read_file(&path, &ReadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(said.contains("more rows than fit into the file"), "{said}");
}
