//! `sandbox draw`: sizes and resolutions of files, colors of agents, paths, animations, every source of a run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use image::Rgb;

use crate::common::program::{refused, run, run_json, stderr, text};
use sandbox::output::colors::ColorMap;

/// Four standing agents far from each other, and one agent that walks to the right at 1 m/s along y = 1.
const HALL: &str = r#"{"name": "hall", "duration_secs": 20, "profile": "sph", "preferred_speed": 1,
    "walkable_area": [[[[0,0],[20,0],[20,10],[0,10]]]],
    "view": {"region": [[0,0],[20,10]], "density_range": [0, 4]},
    "agents": [{"position": [2,5], "goal": [2,5]}, {"position": [8,5], "goal": [8,5]},
               {"position": [8.5,5], "goal": [8.5,5]}, {"position": [14,8], "goal": [14,8]},
               {"position": [2,1.5], "goal": [19,1.5]}]}"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("hall.json"), HALL).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Draws the hall, or another run in the folder, and returns the path of the picture.
    fn draw(&self, run_name: &str, out: &str, options: &[&str]) -> PathBuf {
        let (from, out) = (self.path(run_name), self.path(out));
        let draw = ["draw", text(&from), "--force", "-o", text(&out)];
        let output = run(&[&draw[..], options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        out
    }
}

/// The chunks of a PNG: names and data.
fn chunks(png: &[u8]) -> Vec<(String, Vec<u8>)> {
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    let (mut at, mut found) = (8, Vec::new());
    while at < png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        let name = String::from_utf8(png[at + 4..at + 8].to_vec()).unwrap();
        found.push((name, png[at + 8..at + 8 + length].to_vec()));
        at += 12 + length;
    }
    found
}

/// Pixels per meter, in both directions.
fn resolution(png: &[u8]) -> [u32; 2] {
    let chunks = chunks(png);
    let (_, data) = chunks.iter().find(|(name, _)| name == "pHYs").unwrap();
    assert_eq!(data[8], 1, "the unit is the meter");
    [0, 4].map(|at| u32::from_be_bytes(data[at..at + 4].try_into().unwrap()))
}

/// The number of pixels of a picture with this color.
fn count(picture: &Path, color: [u8; 3]) -> usize {
    let image = image::open(picture).unwrap().to_rgb8();
    image.pixels().filter(|&&pixel| pixel == Rgb(color)).count()
}

#[test]
fn a_png_has_the_width_and_the_resolution_that_are_asked_for() {
    let folder = Folder::new();
    for (options, width, dpi) in [
        (&["--width", "85"][..], 1004, 300.0),
        (&["--width", "85mm", "--dpi", "150"], 502, 150.0),
        (&["--width", "640px"], 640, 300.0),
        (&["--paper", "85"], 1004, 300.0),
        (&[], 2126, 300.0),
    ] {
        let png = folder.draw("hall.json", "hall.png", options);
        assert_eq!(
            image::image_dimensions(&png).unwrap().0,
            width,
            "{options:?}"
        );
        let per_meter: f64 = dpi / 0.0254;
        assert_eq!(
            resolution(&fs::read(&png).unwrap()),
            [per_meter.round() as u32; 2]
        );
    }
}

#[test]
fn papers_get_no_title_and_text_of_eight_points_or_more() {
    let folder = Folder::new();
    for width in ["85", "180"] {
        let svg = folder.draw("hall.json", "hall.svg", &["--paper", width]);
        let svg = fs::read_to_string(svg).unwrap();
        assert!(
            !svg.contains("\nhall\n") && !svg.contains("agents\n"),
            "no titles"
        );
        assert!(svg.contains("x [m]"));
        let points = width.parse::<f64>().unwrap() * 72.0 / 25.4;
        let said: f64 = between(&svg, "width=\"", "pt\"").parse().unwrap();
        assert!((said - points).abs() < 0.3, "{said} {points}");
        // Four units are a point.
        let sizes = svg.split("font-size=\"").skip(1);
        let sizes = sizes.map(|rest| rest.split('"').next().unwrap().parse::<f64>().unwrap() / 4.0);
        let least = sizes.fold(f64::INFINITY, f64::min);
        assert!((8.0..9.0).contains(&least), "{least}");
    }
    let titled = folder.draw("hall.json", "hall.svg", &[]);
    assert!(fs::read_to_string(titled).unwrap().contains("5 agents"));
}

fn between<'a>(text: &'a str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text.split_once(begin).unwrap();
    rest.split_once(end).unwrap().0
}

#[test]
fn a_pdf_has_a_page_of_the_width_and_embeds_its_font() {
    let folder = Folder::new();
    let pdf = folder.draw("hall.json", "hall.pdf", &["--paper", "85"]);
    let bytes = fs::read(pdf).unwrap();
    assert!(bytes.starts_with(b"%PDF-") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
    let words = String::from_utf8_lossy(&bytes);
    let sizes = between(&words, "/MediaBox [", "]").split_whitespace();
    let sizes: Vec<f64> = sizes.map(|size| size.parse().unwrap()).collect();
    assert!((sizes[2] - 85.0 * 72.0 / 25.4).abs() < 0.01, "{sizes:?}");
    assert!(words.contains("/FontFile2") && words.contains("/ToUnicode"));
}

#[test]
fn agents_have_the_colors_of_their_values() {
    let folder = Folder::new();
    // Alone, an agent's density is its own kernel at its place: it has the same color as its mass gives it.
    let (png, csv) = (
        folder.draw("hall.json", "density.png", &["--at", "1"]),
        folder.path("hall.csv"),
    );
    let hall = folder.path("hall.json");
    run(&[
        "run",
        text(&hall),
        "--until",
        "1",
        "--trajectory",
        text(&csv),
    ]);
    let rows = fs::read_to_string(&csv).unwrap();
    let mut lines = rows.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let map = ColorMap::viridis([0.0, 4.0]);
    let mut seen = 0;
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let value = |name: &str| cells[column(name)].parse::<f64>().unwrap();
        if value("time") == 1.0 {
            let color = map.color(value("density") as f32);
            // A disc has an area of some hundred pixels.
            assert!(count(&png, color) > 100, "{} {color:?}", value("density"));
            seen += 1;
        }
    }
    assert_eq!(seen, 5);
    // All agents are below the range, or above it.
    for (range, end) in [("7,9", 7.0), ("0.001,0.01", 0.01)] {
        let png = folder.draw("hall.json", "range.png", &["--range", range]);
        let ends: Vec<f32> = range.split(',').map(|end| end.parse().unwrap()).collect();
        let color = ColorMap::viridis([ends[0], ends[1]]).color(end);
        assert!(count(&png, color) > 500, "{range}");
    }
}

#[test]
fn paths_lead_through_the_positions_of_the_last_seconds() {
    let folder = Folder::new();
    let options = [
        "--at", "8", "--trails", "4", "--color", "none", "--range", "0,1",
    ];
    let svg = folder.draw("hall.json", "trails.svg", &options);
    let svg = fs::read_to_string(svg).unwrap();
    assert!(svg.contains("path of the last 4 s"));
    let hall = folder.path("hall.json");
    let at = |time: &str| {
        let inspect = [
            "inspect",
            text(&hall),
            "--agent",
            "4",
            "--at",
            time,
            "--json",
        ];
        let agent = &run_json(&inspect);
        let agent = agent
            .get("agents")
            .and_then(|all| all.get(0))
            .unwrap_or(agent);
        agent["position"][0].as_f64().unwrap()
    };
    let walked = at("8") - at("4");
    assert!(walked > 2.0, "{walked}");
    // The longest line of the color of paths is as long as the way that the agent walked, on the picture's scale.
    let lengths = svg.lines().filter(|line| line.contains("#68748E"));
    let lengths = lengths.filter_map(|line| {
        let points = line.split_once("points=\"")?.1.split('"').next()?;
        let x: Vec<f64> = points
            .split_whitespace()
            .map(|point| point.split(',').next().unwrap().parse().unwrap())
            .collect();
        Some(x.last()? - x.first()?)
    });
    let longest = lengths.fold(0.0, f64::max);
    let [left, right] = ["0", "20"].map(|number| tick(&svg, number));
    let scale = (right - left) / 20.0;
    assert!(
        (longest / scale - walked).abs() < 0.1,
        "{} {walked}",
        longest / scale
    );
}

/// The place of a number below the x axis.
fn tick(svg: &str, number: &str) -> f64 {
    let texts = svg.split("<text ").skip(1);
    let mut below = texts.filter(|text| {
        text.contains("text-anchor=\"middle\"") && text.contains(&format!(">\n{number}\n</text>"))
    });
    between(below.next().unwrap(), "x=\"", "\"")
        .parse()
        .unwrap()
}

#[test]
fn an_animation_has_a_frame_for_each_moment() {
    let folder = Folder::new();
    let moments = [
        "--from", "1", "--to", "2.5", "--fps", "8", "--width", "400px",
    ];
    let gif = folder.draw("hall.json", "walk.gif", &moments);
    let mut decoder = gif::DecodeOptions::new();
    decoder.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = decoder.read_info(fs::File::open(gif).unwrap()).unwrap();
    assert_eq!(decoder.width(), 400);
    let (mut frames, mut hundredths) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        frames += 1;
        hundredths += u32::from(frame.delay);
    }
    assert_eq!((frames, hundredths), (12, 150));
    let png = folder.draw("hall.json", "walk.png", &moments);
    let chunks = chunks(&fs::read(png).unwrap());
    let named = |name: &str| chunks.iter().filter(|(own, _)| own == name).count();
    assert_eq!((named("acTL"), named("fcTL")), (1, 12));
}

#[test]
fn a_video_without_ffmpeg_is_refused_with_another_format() {
    let folder = Folder::new();
    let (hall, out) = (folder.path("hall.json"), folder.path("walk.mp4"));
    let output = Command::new(env!("CARGO_BIN_EXE_sandbox"))
        .args([
            "draw",
            text(&hall),
            "--from",
            "1",
            "--to",
            "2",
            "-o",
            text(&out),
        ])
        .env("PATH", folder.path(""))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("ffmpeg") && said.contains(".gif"), "{said}");
    assert!(!out.exists());
}

#[test]
fn trajectories_and_recordings_show_the_same_people_as_the_simulation() {
    let folder = Folder::new();
    let hall = folder.path("hall.json");
    let [rrd, sqlite, csv] = ["hall.rrd", "hall.sqlite", "hall.csv"].map(|name| folder.path(name));
    let run_it = [
        "run",
        text(&hall),
        "--until",
        "3",
        "--save",
        text(&rrd),
        "--trajectory",
        text(&sqlite),
        "--trajectory",
        text(&csv),
    ];
    assert_eq!(run(&run_it).status.code(), Some(0));
    for name in ["hall.json", "hall.rrd", "hall.sqlite", "hall.csv"] {
        let (from, out) = (folder.path(name), folder.path("all.png"));
        let draw = [
            "draw",
            text(&from),
            "--at",
            "2",
            "--color",
            "pressure",
            "--force",
            "--json",
            "-o",
            text(&out),
        ];
        let drawn = run_json(&draw);
        assert_eq!(drawn["agents"], 5, "{name}");
        assert!(
            (drawn["time_secs"].as_f64().unwrap() - 2.0).abs() < 0.06,
            "{name}"
        );
    }
    let fields = folder.draw(
        "hall.sqlite",
        "field.png",
        &["--at", "2", "--field", "density"],
    );
    let none = ColorMap::viridis([0.0, 8.0]).color(0.0);
    assert!(
        count(&fields, none) > 10_000,
        "empty floor has the first color"
    );
}

#[test]
fn what_cannot_be_drawn_is_refused_with_advice() {
    let folder = Folder::new();
    let hall = folder.path("hall.json");
    let csv = folder.path("hall.csv");
    run(&[
        "run",
        text(&hall),
        "--until",
        "1",
        "--trajectory",
        text(&csv),
    ]);
    let out = folder.path("no.png");
    let draw = |from: &Path, options: &[&str], words: &[&str]| {
        let draw = ["draw", text(from), "-o", text(&out)];
        refused(&[&draw[..], options].concat(), 2, words);
        assert!(!out.exists());
    };
    draw(
        &hall,
        &["--color", "presure"],
        &["pressure", "rest_density", "preferred_speed", "none"],
    );
    draw(&csv, &["--color", "group"], &["group", "no numbers"]);
    draw(&csv, &["--at", "50"], &["from 0.00 s to 1.00 s"]);
    draw(&csv, &["--seed", "2"], &["--seed", "scenario"]);
    draw(&hall, &["--unit", "cm"], &["--unit", "trajectory"]);
    draw(&hall, &["--range", "2,1"], &["FROM,TO"]);
    draw(&hall, &["--width", "5"], &["millimeters", "px"]);
    draw(&hall, &["--from", "2", "--to", "2"], &["0 frames"]);
    draw(
        &hall,
        &["--from", "2", "--to", "1"],
        &["--to 1 is before --from 2"],
    );
    let video = folder.path("still.gif");
    refused(
        &["draw", text(&hall), "-o", text(&video)],
        2,
        &["--from", "--to"],
    );
}
