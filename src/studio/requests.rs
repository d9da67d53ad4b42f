//! The requests of pages: `docs/reference/studio.md` lists them.

use std::collections::HashMap;
use std::ffi::OsString;
use std::time::Duration;

use output::recording::Address;
use serde_json::{Value, json};

use crate::answer::{Answer, Refusal};
use crate::drawing;
use crate::drawings::Drawings;
use crate::feed::Known;
use crate::page;
use crate::play::Play;
use crate::player::Player;
use crate::plays::Plays;
use crate::saved::Played;

/// The longest time that a page waits for frames.
const LONGEST_WAIT: u64 = 1000;
/// The most frames of one step.
const MOST_FRAMES: u64 = 10_000;

/// A request, after its address has been checked.
pub struct Request<'a> {
    /// Whether it changes something.
    pub is_post: bool,
    /// The path below the token, without its first slash.
    pub path: &'a str,
    /// The part after `?`.
    pub query: &'a str,
    /// The content.
    pub body: &'a [u8],
}

/// What answers requests.
pub struct Answers {
    /// The scenario of the command line.
    pub given: Option<Value>,
    /// Main memory for a run, bytes; `None`: no limit.
    pub memory: Option<u64>,
    /// The Rerun viewer that shows the runs, too.
    pub viewer: Option<Address>,
    /// The program, and its first arguments.
    pub program: Vec<OsString>,
    /// The drawings of pages.
    pub drawings: Drawings,
    /// All runs.
    pub plays: Plays,
}

impl Answers {
    /// The answer to a request.
    pub fn to(&self, request: &Request) -> Answer {
        self.answer(request)
            .unwrap_or_else(|refusal| refusal.answer())
    }

    fn answer(&self, request: &Request) -> Result<Answer, Refusal> {
        let path: Vec<&str> = request.path.split('/').collect();
        let query = values(request.query);
        match (request.is_post, path.as_slice()) {
            (false, [""]) => Ok(Answer::of("text/html; charset=utf-8", page::text())),
            (false, ["schema"]) => Ok(Answer::json(&drawing::schema())),
            (false, ["start"]) => Ok(Answer::json(&json!({
                "given": self.given, "examples": drawing::examples()?, "drawings": self.drawings.list(),
                "runs": self.plays.list(),
            }))),
            (false, ["example"]) => {
                let name = query.get("name").map_or("", String::as_str);
                Ok(Answer::json(
                    &json!({"document": drawing::example(name)?, "notes": []}),
                ))
            }
            (true, ["check"]) => {
                let document = request.json()?;
                let found = drawing::check(&document, self.memory);
                if let Some(key) = query.get("drawing") {
                    self.drawings.keep(key, document)?;
                }
                Ok(Answer::json(&found))
            }
            (false, ["drawings", key]) => {
                Ok(Answer::json(&json!({"document": self.drawings.get(key)?})))
            }
            (true, ["drawings", key, "forget"]) => {
                self.drawings.forget(key)?;
                Ok(Answer::json(&json!({})))
            }
            (true, ["import"]) => {
                let files = files(&query, request.body)?;
                Ok(Answer::json(&drawing::opened(&files)?))
            }
            (true, ["runs"]) => {
                let document = request.json()?;
                let scenario = drawing::scenario(&document, self.memory)?;
                let number = self
                    .plays
                    .add(|| Play::begin(scenario, document, self.viewer.clone()))?;
                Ok(Answer::json(&json!({"run": number})))
            }
            (false, ["runs", number]) => self.described(number),
            (is_post, ["runs", number, what]) => {
                let number = parsed("the number of the run", number)?;
                self.of_run((is_post, what), number, request, &query)
            }
            _ => Err(nothing(request)),
        }
    }

    /// A run: what does not change.
    fn described(&self, number: &str) -> Result<Answer, Refusal> {
        let number = parsed("the number of the run", number)?;
        let play = self.plays.get(number)?;
        let about = play.ask(|player| (player.scene(), player.run().scenario.duration_secs));
        let (scene, duration) = about?;
        Ok(Answer::json(&json!({
            "id": number, "name": play.name, "document": *play.document, "scene": scene,
            "controls": *play.controls, "duration_secs": duration, "state": play.feed.state(),
        })))
    }

    fn of_run(
        &self,
        what: (bool, &str),
        number: u64,
        request: &Request,
        query: &HashMap<String, String>,
    ) -> Result<Answer, Refusal> {
        let play = self.plays.get(number)?;
        match what {
            (false, "frames") => frames(&play, query),
            (false, "person") => {
                let number = number_of(query, "id")?;
                let id = u32::try_from(number)
                    .map_err(|_| Refusal::wrong("id: there is no such person"))?;
                Ok(Answer::json(&play.ask(move |player| player.person(id))??))
            }
            (false, "digest") => Ok(Answer::json(&play.ask(|player| player.digest())??)),
            (false, "saved") => {
                let ending = query.get("as").map_or("json", String::as_str);
                let played = play.ask(|player| {
                    player.shown().map(|run| Played {
                        scenario: (*run.scenario).clone(),
                        document: run.played(),
                        time: run.simulation.frame().clock.time(),
                    })
                })??;
                played.file(ending, &self.program)
            }
            (true, "control") => {
                let asked = request.json()?;
                let state = play.ask(move |player| controlled(player, &asked))??;
                Ok(Answer::json(&json!({"state": state})))
            }
            (true, "intervene") => {
                let keys = request.json()?;
                let added = play.ask(move |player| player.intervene(&keys))??;
                Ok(Answer::json(
                    &json!({"ids": added.ids, "without_room": added.without_room}),
                ))
            }
            (true, "fork") => {
                let number = self.plays.add(|| play.fork())?;
                Ok(Answer::json(&json!({"run": number})))
            }
            (true, "close") => {
                self.plays.close(number)?;
                Ok(Answer::json(&json!({})))
            }
            _ => Err(nothing(request)),
        }
    }
}

/// The frames after those that a page knows.
fn frames(play: &Play, query: &HashMap<String, String>) -> Result<Answer, Refusal> {
    let known = Known {
        epoch: number_of(query, "epoch")?,
        after: number_of(query, "after")?,
        changes: number_of(query, "changes").ok(),
    };
    let wait = Duration::from_millis(number_of(query, "wait").unwrap_or(0).min(LONGEST_WAIT));
    let parts = play.feed.after(&play.live, known, wait);
    let answer = parts.map(|parts| Answer::of("application/octet-stream", parts));
    answer.ok_or_else(|| Refusal::with(404, "the run is closed"))
}

/// Does what a page asks for, in this order, and returns the state.
fn controlled(player: &mut Player, asked: &Value) -> Result<Value, Refusal> {
    const KEYS: [&str; 5] = ["speed", "follow", "to", "step", "play"];
    let Some(keys) = asked.as_object() else {
        let known = KEYS.join(", ");
        return Err(Refusal::wrong(format!(
            "give an object with some of the keys {known}"
        )));
    };
    if let Some(unknown) = keys.keys().find(|key| !KEYS.contains(&key.as_str())) {
        return Err(Refusal::wrong(format!(
            "{unknown}: unknown key; there are {}",
            KEYS.join(", ")
        )));
    }
    if let Some(speed) = keys.get("speed") {
        let is_known = speed.is_null() || speed.is_f64() || speed.is_u64();
        let number = speed.as_f64().filter(|_| is_known);
        if !is_known {
            return Err(Refusal::wrong("speed: give a number or null"));
        }
        player.set_speed(number)?;
    }
    if let Some(id) = keys.get("follow") {
        let known = id.as_u64().and_then(|id| u32::try_from(id).ok());
        if known.is_none() && !id.is_null() {
            return Err(Refusal::wrong("follow: give the id of a person, or null"));
        }
        player.follow(known);
    }
    if let Some(to) = keys.get("to") {
        let secs = to.as_f64();
        player.go_to(secs.ok_or_else(|| Refusal::wrong("to: give a time in seconds"))?)?;
    }
    if let Some(step) = keys.get("step") {
        let frames = step.as_u64().filter(|&frames| frames <= MOST_FRAMES);
        player.step_by(frames.ok_or_else(|| {
            Refusal::wrong(format!(
                "step: give a number of frames, from 0 to {MOST_FRAMES}"
            ))
        })?)?;
    }
    if let Some(play) = keys.get("play") {
        let play = play.as_bool();
        player.set_playing(play.ok_or_else(|| Refusal::wrong("play: give true or false"))?);
    }
    Ok(player.state())
}

impl Request<'_> {
    /// The content as JSON.
    fn json(&self) -> Result<Value, Refusal> {
        serde_json::from_slice(self.body)
            .map_err(|error| Refusal::wrong(format!("the request: {error}")))
    }
}

fn nothing(request: &Request) -> Refusal {
    let method = if request.is_post { "POST" } else { "GET" };
    Refusal::with(
        404,
        format!("{method} {}: there is no such request", request.path),
    )
}

fn parsed(what: &str, text: &str) -> Result<u64, Refusal> {
    text.parse()
        .map_err(|_| Refusal::wrong(format!("{what}: {text}: give a whole number")))
}

fn number_of(query: &HashMap<String, String>, key: &str) -> Result<u64, Refusal> {
    let text = query.get(key);
    parsed(
        key,
        text.ok_or_else(|| Refusal::wrong(format!("{key} is missing")))?,
    )
}

/// The files of a request, by name: one, or several, one after the other, whose names and lengths are a JSON list.
fn files<'a>(
    query: &HashMap<String, String>,
    body: &'a [u8],
) -> Result<Vec<(String, &'a [u8])>, Refusal> {
    let Some(list) = query.get("files") else {
        let name = query.get("name").cloned().unwrap_or_default();
        return Ok(vec![(name, body)]);
    };
    let wrong = || {
        let message = "files: give a list of [name, bytes], as long together as the request";
        Refusal::wrong(message)
    };
    let list: Vec<(String, usize)> = serde_json::from_str(list).map_err(|_| wrong())?;
    let mut rest = body;
    let mut files = Vec::new();
    for (name, length) in list {
        let (content, after) = rest.split_at_checked(length).ok_or_else(wrong)?;
        files.push((name, content));
        rest = after;
    }
    match rest.is_empty() && !files.is_empty() {
        true => Ok(files),
        false => Err(wrong()),
    }
}

/// The values of a query, decoded.
fn values(query: &str) -> HashMap<String, String> {
    let pairs = query.split('&').filter_map(|pair| pair.split_once('='));
    pairs
        .map(|(key, value)| (decoded(key), decoded(value)))
        .collect()
}

/// A text in which bytes may be written as `%41` and blanks as `+`.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = (first == b'%').then(|| after.get(..2)).flatten();
        let byte = digits
            .and_then(|digits| std::str::from_utf8(digits).ok())
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        rest = match byte {
            Some(_) => &after[2..],
            None => after,
        };
        bytes.push(byte.unwrap_or(if first == b'+' { b' ' } else { first }));
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_a_query_are_decoded() {
        let values = values("name=my%20plan+2.dxf&x=%&y=%zz&z=%C3%A4");
        assert_eq!(values["name"], "my plan 2.dxf");
        assert_eq!(values["x"], "%");
        assert_eq!(values["y"], "%zz");
        assert_eq!(values["z"], "ä");
    }
}
