//! Trajectories of other programs, valid and broken.

use crate::common::tracks::{file, read_as};
use crate::common::vector;
use rusqlite::Connection;
use sandbox::scenario::trajectories::{OnLevel, ReadOptions, Tracks, Unit, read};

const PLAIN: ReadOptions = ReadOptions {
    unit: None,
    fps: None,
    level: OnLevel::Only,
};

fn read_text(text: &str) -> Tracks {
    read_as("crowd.txt", text, &PLAIN).unwrap()
}

/// All rows: (frame, id, x, y).
fn rows(tracks: &Tracks) -> Vec<(i64, i64, f64, f64)> {
    let frames = 0..tracks.frames.len();
    let rows = frames.flat_map(|k| tracks.rows(k).map(move |row| (k, row)));
    rows.map(|(k, row)| {
        let (p, id) = (
            tracks.position[row],
            tracks.ids[tracks.person[row] as usize],
        );
        (tracks.frames[k], id, p.x, p.y)
    })
    .collect()
}

#[test]
fn text_files_are_read_with_all_common_headers() {
    let expected = [(3, 1, 1.5, -2.0), (3, 2, 0.25, 4.0), (4, 1, 1.75, -2.0)];
    let lines = |separator: &str, factor: f64, rest: &str| {
        let line = |id: i64, frame: i64, x: f64, y: f64| {
            let cells = [id.to_string(), frame.to_string()];
            let place = [x * factor, y * factor].map(|x| x.to_string());
            format!("{}{rest}\n", [cells, place].concat().join(separator))
        };
        // Unsorted.
        line(1, 4, 1.75, -2.0) + &line(2, 3, 0.25, 4.0) + &line(1, 3, 1.5, -2.0)
    };
    for (header, separator, factor, rest, fps) in [
        (
            "# framerate: 10.00\n# id frame x/m y/m z/m\n",
            "\t",
            1.0,
            "\t0",
            10.0,
        ),
        (
            "#framerate: 16 fps\n#ID\tFR\tX\tY\tZ\n",
            "  ",
            1.0,
            " 1.7",
            16.0,
        ),
        (
            "# framerate: 25\n# id frame x/cm y/cm z/cm\n",
            " ",
            100.0,
            " 170",
            25.0,
        ),
        (
            "# Framerate: 12.5\n# x and y in cm\n\n",
            " ",
            100.0,
            "",
            12.5,
        ),
        ("# framerate 8\n", " ", 1.0, "", 8.0),
        (
            "# framerate: 8\r\nid frame x [m] y [m]\r\n",
            " ",
            1.0,
            "\r",
            8.0,
        ),
    ] {
        let tracks = read_text(&(header.to_owned() + &lines(separator, factor, rest)));
        assert_eq!(rows(&tracks), expected, "{header}");
        assert_eq!(tracks.fps, fps, "{header}");
    }
}

#[test]
fn frame_rates_are_found_as_they_are_written() {
    for (comment, fps) in [
        (" Framerate = 25", 25.0),
        ("frame rate: 12.5 (camera 3)", 12.5),
        ("framerate=30fps, of 2 cameras", 30.0),
        ("framerate information: 1e1/s", 10.0),
    ] {
        let tracks = read_text(&format!("#{comment}\n# id: the agent\n1 2 3 4\n"));
        assert_eq!((tracks.fps, tracks.time(2)), (fps, 2.0 / fps), "{comment}");
    }
    for comment in [" framerate: unknown", " 25 frames"] {
        let text = format!("#{comment}\n1 2 3 4\n");
        let said = read_as("a.txt", &text, &PLAIN).unwrap_err();
        assert!(said.starts_with("a.txt: it has no frame rate "), "{said}");
    }
}

#[test]
fn columns_follow_the_order_in_the_header() {
    let tracks = read_text("# framerate: 5\n# frame y/m x/m id\n7 2 1 30\n8.0 3 1 30.0\n");
    assert_eq!(rows(&tracks), [(7, 30, 1.0, 2.0), (8, 30, 1.0, 3.0)]);
    assert_eq!(tracks.time(8), 1.6);
    let tracks = read_text("# framerate: 5\n# y[cm] x[cm] frame ID\n200 100 7.0 3\n");
    assert_eq!(rows(&tracks), [(7, 3, 1.0, 2.0)]);
}

#[test]
fn options_override_the_file_and_a_note_says_so() {
    let options = ReadOptions {
        unit: Some(Unit::Centimeter),
        fps: Some(20.0),
        ..PLAIN
    };
    let text = "# framerate: 10\n# id frame x/m y/m\n1 0 100 50\n";
    let tracks = read_as("a.txt", text, &options).unwrap();
    assert_eq!((tracks.fps, tracks.position[0]), (20.0, vector(1.0, 0.5)));
    assert_eq!(
        tracks.notes,
        [
            "--fps 20 is taken, not the file's own 10",
            "--unit cm is taken, not the file's own m"
        ]
    );
}

#[test]
fn mistakes_are_reported_with_the_line_and_the_fix() {
    let head = "# framerate: 10\n# id frame x/m y/m\n";
    for (name, text, expected) in [
        ("a.txt", String::new(), "a.txt: it contains no persons"),
        ("a.txt", head.to_owned(), "a.txt: it contains no persons"),
        (
            "a.txt",
            "1 0 0 0\n".to_owned(),
            "a.txt: it has no frame rate (a line like `# framerate: 25`); give --fps",
        ),
        (
            "a.txt",
            format!("{head}1 0 0 0\n1 1 nan 0\n"),
            "a.txt:4: x is \"nan\", not a finite number",
        ),
        (
            "a.txt",
            format!("{head}1 0 0 inf\n"),
            "a.txt:3: y is \"inf\", not a finite number",
        ),
        (
            "a.txt",
            format!("{head}1 0 0\n"),
            "a.txt:3: y belongs in column 4, and there are only 3",
        ),
        (
            "a.txt",
            format!("{head}1.5 0 0 0\n"),
            "a.txt:3: the id \"1.5\" is not a whole number",
        ),
        (
            "a.txt",
            format!("{head}1,0,0,0\n"),
            "a.txt:3: the id \"1,0,0,0\" is not a whole number; columns are separated by blanks or tabs here, \
             by commas in a .csv",
        ),
        (
            "a.txt",
            format!("{head}1 0 0 0\n2 0 1 1\n1 0 0 0.5\n"),
            "a.txt:5: person 1 is in frame 0 already, by line 3; each may be there once: remove one",
        ),
        (
            "a.txt",
            "# framerate: 10\n# id frame x/km y/km\n1 0 0 0\n".to_owned(),
            "a.txt:2: the unit \"km\" is not known; m, cm, mm, ft are, or give --unit",
        ),
        (
            "a.rrd",
            "RRF2 and more than sixteen bytes".to_owned(),
            "a.rrd: a recording has no trajectories to read; run its scenario again with --trajectory FILE",
        ),
        (
            "a.csv",
            "a,b\n1,2\n".to_owned(),
            "a.csv:1: the first line must name the columns id, frame or time, x and y",
        ),
        (
            "a.csv",
            "id;frame;time;x;y\n1;0;0,00;0,0;0,5,5\n".to_owned(),
            "a.csv:2: y is \"0,5,5\", not a finite number",
        ),
        (
            "a.csv",
            "\"t\",\"id\",\"x\",\"y\"\nlate,1,0,0\n".to_owned(),
            "a.csv:2: time is \"late\", not a finite number",
        ),
        (
            "a.csv",
            "id,frame,time[h],x,y\n1,0,0,0,0\n".to_owned(),
            "a.csv:1: the unit \"h\" of the time is not known; s and ms are",
        ),
        (
            "a.csv",
            "frame,time,id,pos_x,pos_y\n0,0,1,0,0\n1,0.1,1,zero,0\n".to_owned(),
            "a.csv:3: x is \"zero\", not a finite number",
        ),
    ] {
        assert_eq!(read_as(name, &text, &PLAIN).unwrap_err(), expected);
    }
    let missing = read("no/such.txt".as_ref(), &PLAIN)
        .unwrap_err()
        .to_string();
    assert!(
        missing.starts_with("no/such.txt: cannot be read: "),
        "{missing}"
    );
}

#[test]
fn numbers_out_of_range_are_refused_with_their_line() {
    let frames = "out of range: at most 2^53 = 9007199254740992 before or after 0";
    let place = "m is out of range: x and y must be at least -1e9 and at most 1e9 m";
    for (rows, expected) in [
        (
            "1 -9223372036854775808 0 0\n1 9223372036854775807 0.1 0\n2 0 1 1\n",
            format!("a.txt:2: the frame -9223372036854775808 is {frames}"),
        ),
        (
            "1 0 0 0\n1 9007199254740993 0 0\n",
            format!("a.txt:3: the frame 9007199254740993 is {frames}"),
        ),
        ("1 0 1e300 0\n", format!("a.txt:2: (1e300, 0e0) {place}")),
        ("1 0 0 -1.1e9\n", format!("a.txt:2: (0e0, -1.1e9) {place}")),
    ] {
        let text = format!("# framerate: 10\n{rows}");
        assert_eq!(read_as("a.txt", &text, &PLAIN).unwrap_err(), expected);
    }
    let heavy = "id,frame,x,y,time,mass\n1,0,0,0,0,1\n1,1,0,0,0.1,1e300\n";
    assert_eq!(
        read_as("a.csv", heavy, &PLAIN).unwrap_err(),
        "a.csv:3: the mass 1e300 is above 1e6"
    );
    let far = "# framerate: 10\n# in m\n-9223372036854775808 -9007199254740992 -1e9 1e9\n\
               9223372036854775807 9007199254740992 0 0\n";
    let tracks = read_text(far);
    assert_eq!(tracks.span(), (1 << 54) + 1);
    assert_eq!(tracks.ids, [i64::MIN, i64::MAX]);
}

#[test]
fn frame_rates_out_of_range_are_refused_with_their_line() {
    let words = |fps: &str| {
        format!("the frame rate \"{fps}\" is not a number between 1e-6 and 1e6; give --fps")
    };
    let given = ReadOptions {
        fps: Some(5.0),
        ..PLAIN
    };
    for fps in ["1e-300", "1e300", "nan", "0", "-5", "inf", "0.0"] {
        let text = format!("# a film\n# framerate: {fps} fps\n1 0 0 0\n");
        let expected = format!("a.txt:2: {}", words(fps));
        assert_eq!(read_as("a.txt", &text, &PLAIN).unwrap_err(), expected);
        assert_eq!(read_as("a.txt", &text, &given).unwrap().fps, 5.0);
    }
    for (time, fps) in [
        ("0", "inf"),
        ("1e300", "1e-300"),
        ("-1", "-1e0"),
        ("NaN", "NaN"),
    ] {
        let text = format!("id,frame,x,y,time\n1,0,0,0,0\n1,1,0,0,{time}\n");
        let said = read_as("a.csv", &text, &PLAIN).unwrap_err();
        assert!(said.starts_with("a.csv: frame 1 at "), "{said}");
        let end = format!("makes {fps} frames per second: frame f is at f / fps; give --fps");
        assert!(said.ends_with(&end), "{said}");
        assert_eq!(read_as("a.csv", &text, &given).unwrap().fps, 5.0);
    }
    let (_folder, path) = file("jps.sqlite", "");
    let connection = Connection::open(&path).unwrap();
    connection
        .execute_batch(
            "CREATE TABLE trajectory_data (frame, id, pos_x, pos_y);
             CREATE TABLE metadata (key, value);
             INSERT INTO trajectory_data VALUES (0, 1, 2.0, 2.0);
             INSERT INTO metadata VALUES ('fps', '1e-300');",
        )
        .unwrap();
    drop(connection);
    let said = read(&path, &PLAIN).unwrap_err().to_string();
    let expected = format!("{}: metadata: {}", path.display(), words("1e-300"));
    assert_eq!(said, expected);
    assert_eq!(read(&path, &given).unwrap().fps, 5.0);
}

#[test]
fn gaps_empty_frames_and_unusual_steps_are_noted() {
    let tracks =
        read_text("# framerate: 10\n# in m\n1 0 0 0\n1 1 0 0\n1 4 0 0\n1 5 0 0\n2 1 5 5\n");
    assert_eq!(tracks.step, 1);
    assert_eq!(
        tracks.notes,
        [
            "1 gap(s) in which a person is missing, the longest 0.30 s; no motion is measured across",
            "2 frame(s) contain no persons; they count as empty"
        ]
    );
    let tenth = read_text("# framerate: 50\n# in m\n1 10 0 0\n1 15 0 0\n1 20 0 0\n");
    assert_eq!((tenth.step, tenth.span(), tenth.interval()), (5, 3, 0.1));
    assert_eq!(tenth.notes, ["frames are numbered in steps of 5"]);
}

#[test]
fn centimeters_without_a_unit_give_a_warning() {
    let walk = |step: f64| -> String {
        let lines = (0..20).map(|frame| format!("1 {frame} {} 0\n", step * f64::from(frame)));
        "# framerate: 10\n".to_owned() + &lines.collect::<String>()
    };
    let meters = "no unit is given in the file (x/m or x/cm) or by --unit: meters are taken";
    assert_eq!(read_text(&walk(0.13)).notes, [meters]);
    assert_eq!(
        read_text(&walk(13.0)).notes,
        [
            meters,
            "half of all steps are faster than 130 m/s, 100 times as fast as people walk: with --unit cm it is 1.30 m/s"
        ]
    );
}

#[test]
fn csv_columns_are_found_by_name() {
    let text = "frame,time,id,group,pos_x,pos_y,mass\n0,0,4,all,1,2,0.9\n1,0.5,4,all,1.5,2,0.9\n";
    let tracks = read_as("run.csv", text, &PLAIN).unwrap();
    assert_eq!(rows(&tracks), [(0, 4, 1.0, 2.0), (1, 4, 1.5, 2.0)]);
    assert_eq!((tracks.fps, &tracks.mass), (2.0, &vec![0.9; 2]));
    assert!(tracks.notes.is_empty(), "{:?}", tracks.notes);
}

#[test]
fn both_versions_of_jupedsims_format_are_read() {
    let version_1 = "
        CREATE TABLE trajectory_data (frame INTEGER, id INTEGER, pos_x REAL, pos_y REAL, ori_x REAL, ori_y REAL);
        CREATE TABLE metadata (key TEXT, value TEXT);
        CREATE TABLE geometry (wkt TEXT);
        INSERT INTO metadata VALUES ('version', '1'), ('fps', '12.5');
        INSERT INTO geometry VALUES ('GEOMETRYCOLLECTION (POLYGON ((0 0, 9 0, 9 9, 0 0)))');
        INSERT INTO trajectory_data VALUES (1, 7, 2.5, 1.0, 1, 0), (0, 7, 2, 1, 1, 0);";
    let version_2 = version_1
        .replace("geometry (wkt", "geometry (hash INTEGER, wkt")
        .replace("geometry VALUES (", "geometry VALUES (17, ");
    for tables in [version_1, &version_2] {
        let (_folder, path) = file("jps.sqlite", "");
        let connection = Connection::open(&path).unwrap();
        connection.execute_batch(tables).unwrap();
        drop(connection);
        let tracks = read(&path, &PLAIN).unwrap();
        assert_eq!(rows(&tracks), [(0, 7, 2.0, 1.0), (1, 7, 2.5, 1.0)]);
        assert_eq!((tracks.fps, tracks.walkable.len()), (12.5, 1));
    }
}

#[test]
fn a_database_without_trajectories_is_refused() {
    for (tables, expected) in [
        (
            "CREATE TABLE a (b)",
            "it has no table trajectory_data: this is no trajectory of JuPedSim",
        ),
        (
            "CREATE TABLE trajectory_data (frame, id, x, y)",
            "its table trajectory_data has no column pos_x",
        ),
        (
            "CREATE TABLE trajectory_data (frame, id, pos_x, pos_y);
             INSERT INTO trajectory_data VALUES (0, 1, 2.0, NULL)",
            "row 1 of trajectory_data: pos_y is not a finite number",
        ),
    ] {
        let (_folder, path) = file("jps.db", "");
        let connection = Connection::open(&path).unwrap();
        connection.execute_batch(tables).unwrap();
        drop(connection);
        let error = read(&path, &PLAIN).unwrap_err().to_string();
        assert_eq!(error, format!("{}: {expected}", path.display()));
    }
}

/// People who walk along x at 1.25 m/s, a row per frame; `time` writes the time of a frame.
fn walkers(fps: f64, time: impl Fn(f64) -> String, header: &str) -> String {
    let mut text = format!("id,frame,{header},x[m],y[m]\n");
    for id in 1..=3 {
        for frame in 1..=200 {
            let secs = f64::from(frame) / fps;
            let x = 1.25 * (secs - 0.8 * f64::from(id));
            text += &format!("{id},{frame},{},{x:.4},0.5\n", time(secs));
        }
    }
    text
}

#[test]
fn the_frame_rate_is_what_all_times_say() {
    // Of 30 frames per second with times of two digits, the first row says 33.3.
    for (fps, digits) in [
        (30.0, 2),
        (24.0, 1),
        (25.0, 3),
        (29.97, 4),
        (12.5, 2),
        (16.0, 6),
    ] {
        let text = walkers(fps, |secs| format!("{secs:.digits$}"), "time");
        let found = read_as("a.csv", &text, &PLAIN).unwrap().fps;
        assert!((found / fps - 1.0).abs() < 1e-5, "{found} for {fps}");
        let is_whole = fps.fract() == 0.0;
        assert!(!is_whole || found == fps, "{found} for {fps}");
    }
    // Times that do not begin at 0, and milliseconds.
    let late = walkers(25.0, |secs| format!("{:.3}", secs + 3600.0), "time");
    assert_eq!(read_as("a.csv", &late, &PLAIN).unwrap().fps, 25.0);
    let fine = walkers(25.0, |secs| format!("{:.0}", 1000.0 * secs), "time[ms]");
    assert_eq!(read_as("a.csv", &fine, &PLAIN).unwrap().fps, 25.0);
}

#[test]
fn texts_with_other_ends_of_lines_or_letters_are_read() {
    let text = "# framerate: 25\n# id frame x/m y/m\n1 0 0 0\n1 1 0.05 0\n2 1 1 1\n";
    let plain = read_as("a.txt", text, &PLAIN).unwrap();
    for ends in ["\r", "\r\n"] {
        let other = read_as("a.txt", &text.replace('\n', ends), &PLAIN).unwrap();
        assert_eq!((&other.frames, &other.ids), (&plain.frames, &plain.ids));
        assert_eq!(other.len(), 3);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    for (mark, unit) in [([0xff, 0xfe], 0), ([0xfe, 0xff], 1)] {
        let letters = text.encode_utf16().map(|letter| match unit {
            0 => letter.to_le_bytes(),
            _ => letter.to_be_bytes(),
        });
        let bytes: Vec<u8> = mark.into_iter().chain(letters.flatten()).collect();
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(rows(&read(&path, &PLAIN).unwrap()), rows(&plain));
    }
}
