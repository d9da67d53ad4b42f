//! A studio, and a browser of plain requests for it, as docs/reference/studio.md describes them.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::page::{People, block};
use super::program::PROGRAM;

/// A run that has not got there after this time hangs.
const LONGEST: Duration = Duration::from_secs(120);

/// Forty people in a room with a door, which they leave by an exit beyond it.
pub fn room() -> Value {
    json!({
        "name": "room", "profile": "steer+sph", "duration_secs": 30,
        "walkable_area": [
            [[[0, 0], [8, 0], [8, 2.5], [8.4, 2.5], [8.4, 0], [12, 0], [12, 6], [8.4, 6], [8.4, 3.5], [8, 3.5], [8, 6],
              [0, 6]]]
        ],
        "exits": [{"name": "out", "line": [[12, 2], [12, 4]]}],
        "doors": [{"name": "door", "line": [[8.2, 2.5], [8.2, 3.5]]}],
        "crowds": [{"name": "people", "area": [[0.5, 0.5], [6, 0.5], [6, 5.5], [0.5, 5.5]], "number": 40}],
    })
}

/// A studio; it ends when it is dropped.
pub struct Studio {
    program: Child,
    /// `127.0.0.1:PORT`.
    pub host: String,
    /// `/TOKEN/`.
    pub root: String,
}

impl Drop for Studio {
    fn drop(&mut self) {
        self.program.kill().ok();
        self.program.wait().ok();
    }
}

/// What a server has answered.
pub struct Reply {
    pub status: u16,
    /// Names in small letters, with values.
    pub headers: Vec<(String, String)>,
    pub content: Vec<u8>,
}

impl Reply {
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.content).unwrap()
    }

    pub fn header(&self, name: &str) -> Option<&str> {
        let found = self.headers.iter().find(|(own, _)| own == name);
        found.map(|(_, value)| value.as_str())
    }
}

/// Some frames of a run.
pub struct Frames {
    pub series: Value,
    /// The people and the known accelerations, frame by frame.
    pub crowds: Vec<People>,
    pub forces: Vec<People>,
}

impl Studio {
    /// Starts the program.
    pub fn start(arguments: &[&str]) -> Self {
        let mut program = Command::new(PROGRAM)
            .args(["studio", "--no-browser", "--json", "--threads", "2"])
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut said = BufReader::new(program.stdout.take().unwrap());
        said.read_line(&mut line).unwrap();
        let said: Value = serde_json::from_str(&line).unwrap();
        let address = said["address"].as_str().unwrap();
        let rest = address.strip_prefix("http://").unwrap();
        let (host, token) = rest.split_once('/').unwrap();
        Self {
            program,
            host: host.to_owned(),
            root: format!("/{token}"),
        }
    }

    /// Sends bytes and reads the answer.
    pub fn raw(&self, bytes: &[u8]) -> Reply {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.write_all(bytes).unwrap();
        let mut all = Vec::new();
        stream.read_to_end(&mut all).unwrap();
        let end = all.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(all[..end].to_vec()).unwrap();
        let mut lines = head.lines();
        let status = lines.next().unwrap().split(' ').nth(1).unwrap();
        let headers = lines.map(|line| line.split_once(": ").unwrap());
        Reply {
            status: status.parse().unwrap(),
            headers: headers
                .map(|(name, value)| (name.to_lowercase(), value.to_owned()))
                .collect(),
            content: all[end + 4..].to_vec(),
        }
    }

    /// Sends bytes and goes away.
    pub fn leave(&self, bytes: &[u8]) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.write_all(bytes).unwrap();
    }

    /// Sends a request for a path with other headers than a browser sends for this page.
    pub fn with(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Reply {
        let has_host = headers.iter().any(|(name, _)| *name == "Host");
        let mut text = format!("{method} {path} HTTP/1.0\r\n");
        if !has_host {
            text += &format!("Host: {}\r\n", self.host);
        }
        for (name, value) in headers {
            text += &format!("{name}: {value}\r\n");
        }
        text += &format!("Content-Length: {}\r\n\r\n", body.len());
        self.raw(&[text.as_bytes(), body].concat())
    }

    pub fn get(&self, path: &str) -> Reply {
        self.with("GET", &format!("{}{path}", self.root), &[], b"")
    }

    pub fn post(&self, path: &str, body: &Value) -> Reply {
        let kind = [("Content-Type", "application/json")];
        let body = body.to_string();
        self.with(
            "POST",
            &format!("{}{path}", self.root),
            &kind,
            body.as_bytes(),
        )
    }

    /// The JSON of a request that succeeds.
    pub fn ask(&self, path: &str, body: &Value) -> Value {
        let reply = match body {
            Value::Null => self.get(path),
            body => self.post(path, body),
        };
        let text = String::from_utf8_lossy(&reply.content).into_owned();
        assert_eq!(reply.status, 200, "{path}: {text}");
        reply.json()
    }

    /// Begins a run of a scenario; returns the first part of the paths of its requests.
    pub fn begin(&self, document: &Value) -> String {
        let begun = self.ask("runs", document);
        format!("runs/{}", begun["run"])
    }

    pub fn control(&self, run: &str, what: &Value) -> Value {
        self.ask(&format!("{run}/control"), what)["state"].clone()
    }

    /// The frames after a number in an epoch.
    pub fn frames(&self, run: &str, epoch: u64, after: u64) -> Frames {
        let scene = self.ask(run, &Value::Null)["scene"].clone();
        let reply = self.get(&format!("{run}/frames?epoch={epoch}&after={after}&wait=0"));
        assert_eq!(reply.status, 200);
        let length = |k: usize| {
            let bytes = reply.content[4 * k..4 * k + 4].try_into().unwrap();
            u32::from_le_bytes(bytes) as usize
        };
        let mut at = 12;
        let mut part = |k: usize| {
            let bytes = &reply.content[at..at + length(k)];
            at += length(k);
            bytes.to_vec()
        };
        let series: Value = serde_json::from_slice(&part(0)).unwrap();
        let radius = scene["units"]["radius"].as_f64().unwrap();
        let columns = scene["columns"].as_array().unwrap().len();
        let terms = scene["terms"].as_array().unwrap().len();
        let mut people = |k, columns| match part(k) {
            bytes if bytes.is_empty() => Vec::new(),
            bytes => block(&bytes, columns, radius),
        };
        Frames {
            crowds: people(1, columns),
            forces: people(2, 2 * terms),
            series,
        }
    }

    /// Waits until the state of a run is as asked.
    pub fn wait(&self, run: &str, is_there: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let state = self.control(run, &json!({}));
            if is_there(&state) {
                return state;
            }
            assert!(start.elapsed() < LONGEST, "{run}: {state}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}
