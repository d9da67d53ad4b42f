//! Engines in Python packages, each in a process of its own that takes steps on request.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use sandbox::engine::simulation::Simulation;
use sandbox::lab::error::LabError;
use serde_json::json;
use tempfile::NamedTempFile;

use super::WIDE;
use super::setting::{Description, Family, Setting, Turn};

/// The end of every script: it reads the agents and answers requests.
const SERVE: &str = include_str!("python/serve.py");

/// A Python package with an engine.
#[derive(Debug, Clone, Copy)]
pub struct Package {
    pub engine: &'static str,
    /// Its name for `pip` and for `import`.
    name: &'static str,
    /// Defines `begin`, see `serve.py`.
    script: &'static str,
    /// Δt, seconds.
    time_step: f64,
    precision: &'static str,
    models: &'static [Model],
}

/// A model of a package.
#[derive(Debug, Clone, Copy)]
struct Model {
    /// Its name in the script.
    name: &'static str,
    family: Family,
    about: &'static str,
    /// Agents farther away have no effect, meters.
    radius: f64,
    all_sizes: bool,
}

/// All packages.
pub const PACKAGES: [Package; 2] = [
    Package {
        engine: "JuPedSim",
        name: "jupedsim",
        script: include_str!("python/jupedsim.py"),
        // The default of its class Simulation.
        time_step: 0.01,
        precision: "f64",
        // The radii are `_cutOffRadius` in the header of each model.
        models: &[
            Model {
                name: "SocialForceModel",
                family: Family::SocialForce,
                about: "social force, circular, friction",
                radius: 2.5,
                all_sizes: true,
            },
            Model {
                name: "CollisionFreeSpeedModel",
                family: Family::CollisionFreeSpeed,
                about: "collision-free speed",
                radius: 3.0,
                all_sizes: true,
            },
            Model {
                name: "AnticipationVelocityModel",
                family: Family::CollisionFreeSpeed,
                about: "anticipation velocity",
                radius: 3.0,
                all_sizes: false,
            },
        ],
    },
    Package {
        engine: "RVO2",
        name: "pyrvo",
        script: include_str!("python/pyrvo.py"),
        // That of its examples.
        time_step: 0.25,
        precision: "f32",
        models: &[
            Model {
                name: "all",
                family: Family::VelocityObstacles,
                about: "ORCA, all neighbors",
                radius: WIDE,
                all_sizes: true,
            },
            Model {
                name: "10",
                family: Family::VelocityObstacles,
                about: "ORCA, 10 nearest neighbors",
                radius: WIDE,
                all_sizes: true,
            },
        ],
    },
];

impl Package {
    /// Its settings, if this Python has it; otherwise the error says how to install it.
    pub fn settings(&self, python: &Path) -> Result<Vec<Setting>, String> {
        let version = self.version(python)?;
        let setting = |model: &Model| {
            let (package, model, python) = (*self, *model, python.to_owned());
            Setting {
                description: Description {
                    engine: format!("{} ({} {version})", self.engine, self.name),
                    family: model.family,
                    model: model.about,
                    radius: model.radius,
                    precision: self.precision,
                    time_step: self.time_step,
                    threads: 1,
                },
                stride: 1,
                all_sizes: model.all_sizes,
                start: Box::new(move |crowd| {
                    let mut walking = Walking::begin(package, model, &python, crowd)?;
                    Ok(Box::new(move |steps| walking.walk(steps)))
                }),
            }
        };
        Ok(self.models.iter().map(setting).collect())
    }

    fn version(&self, python: &Path) -> Result<String, String> {
        let name = self.name;
        let how = |said: &str| {
            format!(
                "`{} -c 'import {name}'` does not work: {said}; `python3 -m venv peers && peers/bin/pip install {}`, \
                 then --python peers/bin/python",
                python.display(),
                PACKAGES.map(|package| package.name).join(" ")
            )
        };
        let code = format!("import {name}, importlib.metadata as m; print(m.version('{name}'))");
        let asked = Command::new(python).args(["-c", &code]).output();
        let asked = asked.map_err(|error| how(&error.to_string()))?;
        if !asked.status.success() {
            let said = String::from_utf8_lossy(&asked.stderr);
            return Err(how(said.lines().last().unwrap_or("no reason given")));
        }
        Ok(String::from_utf8_lossy(&asked.stdout).trim().to_owned())
    }
}

/// A Python process that takes steps on request.
struct Walking {
    engine: &'static str,
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
    _people: NamedTempFile,
}

fn stopped(engine: &str, reason: impl ToString) -> LabError {
    LabError::Data(format!("{engine} stopped: {}", reason.to_string()))
}

impl Walking {
    /// Starts the process, and waits until it has placed all agents.
    fn begin(
        package: Package,
        model: Model,
        python: &Path,
        crowd: &Simulation,
    ) -> Result<Self, LabError> {
        let engine = package.engine;
        let scene = crowd.scene();
        let setting = json!({
            "model": model.name, "time_step": package.time_step, "radius": model.radius,
            "preferred_speed": scene.preferred_speed, "max_speed": scene.max_speed,
        });
        let people = people(crowd).map_err(|error| stopped(engine, error))?;
        let mut child = Command::new(python)
            .arg("-c")
            .arg(format!("{}\n{SERVE}", package.script))
            .arg(people.path())
            .arg(setting.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| stopped(engine, error))?;
        let pipes = child.stdin.take().zip(child.stdout.take());
        let (orders, answers) = pipes.ok_or_else(|| stopped(engine, "no pipes"))?;
        let mut walking = Self {
            engine,
            child,
            orders,
            answers: BufReader::new(answers),
            _people: people,
        };
        let said = walking.answer()?;
        match said == "ready" {
            true => Ok(walking),
            false => Err(stopped(engine, format!("it said {said:?}"))),
        }
    }

    fn answer(&mut self) -> Result<String, LabError> {
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(0) => Err(stopped(self.engine, "see its message above")),
            Ok(_) => Ok(line.trim().to_owned()),
            Err(error) => Err(stopped(self.engine, error)),
        }
    }

    fn walk(&mut self, steps: u64) -> Result<Turn, LabError> {
        writeln!(self.orders, "{steps}").map_err(|error| stopped(self.engine, error))?;
        let said = self.answer()?;
        let numbers: Result<Vec<f64>, _> = said.split_whitespace().map(str::parse).collect();
        match numbers.as_deref() {
            Ok(&[seconds, moved]) => Ok(Turn { seconds, moved }),
            _ => Err(stopped(self.engine, format!("it said {said:?}"))),
        }
    }
}

impl Drop for Walking {
    fn drop(&mut self) {
        // The process only waits for requests. Killing one that has already exited does no harm.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A file with one agent per line: position, radius and goal, meters.
fn people(crowd: &Simulation) -> std::io::Result<NamedTempFile> {
    let mut file = NamedTempFile::new()?;
    let agents = crowd.frame().agents;
    let people = agents.position.iter().zip(&agents.radius).zip(&agents.goal);
    let lines = people
        .map(|((r, radius), goal)| format!("{} {} {radius} {} {}\n", r.x, r.y, goal.x, goal.y));
    file.write_all(lines.collect::<String>().as_bytes())?;
    Ok(file)
}
