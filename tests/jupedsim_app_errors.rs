//! Errors in scenarios of JuPedSim's web app name the file in the archive and the place.

use std::fs;

use serde_json::{Value, json};

use crate::common::program::refused;
use crate::common::zips::{Packing, zip};
use crate::jupedsim_app::{HALL, rectangle, simple};

#[test]
fn errors_name_the_file_in_the_archive_and_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.zip");
    let name = path.to_str().unwrap();
    let refuses = |bytes: &[u8], words: &[&str]| {
        fs::write(&path, bytes).unwrap();
        refused(&["run", name], 2, &[&[name], words].concat());
    };
    let config = |change: &dyn Fn(&mut Value)| {
        let mut config = simple();
        change(&mut config);
        let text = config.to_string();
        zip(
            &[
                ("config.json", text.as_bytes()),
                ("geometry.wkt", HALL.as_bytes()),
            ],
            Packing::Deflated,
        )
    };
    // What does not fit is known only after the translation.
    refuses(
        &config(&|c| {
            c["distributions"]["jps-distributions_0"]["parameters"]["number"] = json!(900)
        }),
        &["crowds[0]", "jps-distributions_0: 900 agents do not fit"],
    );
    let exit = "config.json: exits.jps-exits_0.coordinates";
    refuses(
        &config(&|c| c["exits"] = json!({})),
        &["config.json: exits", "at least one exit"],
    );
    refuses(
        &config(&|c| {
            c["exits"]["jps-exits_0"]["coordinates"] = rectangle([30.0, 0.0], [31.0, 1.0])
        }),
        &[exit, "outside of the walkable area"],
    );
    refuses(
        &config(&|c| c["exits"]["jps-exits_0"]["coordinates"][2] = json!([1, "a"])),
        &[exit, "[2]", "[x, y]"],
    );
    refuses(
        &config(&|c| {
            c["distributions"]["jps-distributions_0"]["parameters"]["number"] = json!(2.5)
        }),
        &[
            "config.json: distributions.jps-distributions_0.parameters.number",
            "whole number",
        ],
    );
    refuses(
        &config(&|c| {
            let parameters = &mut c["distributions"]["jps-distributions_0"]["parameters"];
            parameters["use_flow_spawning"] = true.into();
            parameters["flow_start_time"] = 20.into();
        }),
        &["parameters.flow_end_time", "must be later"],
    );
    refuses(
        &config(&|c| c["zones"] = json!({"z": {"coordinates": [[0, 0], [1, 1]]}})),
        &["zones.z.coordinates"],
    );
    refuses(
        &config(&|c| c["config"]["simulation_settings"] = json!([])),
        &["config.simulation_settings", "object"],
    );
    let text = simple().to_string();
    let with = |files: &[(&str, &[u8])]| zip(files, Packing::Stored);
    let both: [(&str, &[u8]); 2] = [
        ("config.json", text.as_bytes()),
        ("geometry.wkt", b"POLYGON ((0 0, 1 0))"),
    ];
    refuses(&with(&both), &["bad.zip: geometry.wkt: the outline"]);
    refuses(
        &with(&[both[0], ("a.wkt", b""), ("b.wkt", b"")]),
        &["a.wkt, b.wkt", "one .json and one .wkt"],
    );
    refuses(
        &with(&[("a.txt", b"x"), ("b.png", b"y")]),
        &["a zip archive with a.txt, b.png", "one .json and one .wkt"],
    );
    refuses(
        &with(&[("config.json", b"{\n  \"exits\": {,}\n}"), both[1]]),
        &["config.json: line 2", "column"],
    );
    refuses(
        &with(&[("config.json", b"{\"a\": 1}"), both[1]]),
        &["config.json is no scenario of JuPedSim's web app"],
    );
    let whole = with(&both);
    refuses(&whole[..whole.len() - 30], &["cut off or damaged"]);
    let mut changed = whole.clone();
    changed[60] ^= 1;
    refuses(&changed, &["config.json", "damaged"]);
    // The flags and the method of the first entry in the directory.
    let directory = whole
        .windows(4)
        .position(|bytes| bytes == b"PK\x01\x02")
        .unwrap();
    let mut encrypted = whole.clone();
    encrypted[directory + 8] = 1;
    refuses(&encrypted, &["config.json", "is encrypted"]);
    let mut other = whole.clone();
    other[directory + 10] = 12;
    refuses(&other, &["config.json", "method 12"]);
    let mut bomb = whole;
    bomb[directory + 24..directory + 28].copy_from_slice(&u32::MAX.to_le_bytes());
    refuses(&bomb, &["at most 268435456 are unpacked"]);
}
