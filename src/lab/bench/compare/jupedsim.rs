//! JuPedSim's social force model, in a separate Python process.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use tempfile::NamedTempFile;

use super::{Description, Entry};
use crate::engine::simulation::Simulation;
use crate::lab::error::LabError;

const SCRIPT: &str = include_str!("jupedsim.py");
const ENGINE: &str = "JuPedSim";
/// The cutoff radius of its social force, meters: `_cutOffRadius` in its SocialForceModel.hpp.
const RADIUS: f64 = 2.5;

/// JuPedSim, if this Python has it; otherwise the error says how to install it.
pub fn entries(crowd: &Simulation, python: &Path) -> Result<Vec<Entry>, String> {
    let how = |said: &str| {
        format!(
            "`{} -c 'import jupedsim'` does not work: {said}; `python3 -m venv jps && jps/bin/pip install jupedsim`, \
             then --python jps/bin/python",
            python.display()
        )
    };
    let import = ["-c", "import jupedsim"];
    let asked = Command::new(python).args(import).output();
    let asked = asked.map_err(|error| how(&error.to_string()))?;
    if !asked.status.success() {
        let said = String::from_utf8_lossy(&asked.stderr);
        return Err(how(said.lines().last().unwrap_or("no reason given")));
    }
    let (mut walking, version, time_step) =
        Walking::begin(crowd, python).map_err(|error| error.to_string())?;
    let description = Description {
        engine: format!("{ENGINE} {version}"),
        model: "social force, circular, with body force and friction",
        radius: RADIUS,
        precision: "f64",
        time_step,
        threads: 1,
    };
    let contender = Box::new(move |steps| walking.ms_per_step(steps));
    Ok(vec![(description, contender)])
}

/// A Python process that takes steps on request.
struct Walking {
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
    _people: NamedTempFile,
}

fn stopped(reason: impl ToString) -> LabError {
    LabError::Data(format!("{ENGINE} stopped: {}", reason.to_string()))
}

impl Walking {
    /// Starts the process with all agents, and returns its version and its time step in seconds.
    fn begin(crowd: &Simulation, python: &Path) -> Result<(Self, String, f64), LabError> {
        let people = people(crowd).map_err(stopped)?;
        let mut child = Command::new(python)
            .args(["-c", SCRIPT])
            .arg(people.path())
            .arg(crowd.scene().preferred_speed.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(stopped)?;
        let pipes = child.stdin.take().zip(child.stdout.take());
        let (orders, answers) = pipes.ok_or_else(|| stopped("no pipes"))?;
        let mut walking = Self {
            child,
            orders,
            answers: BufReader::new(answers),
            _people: people,
        };
        let ready = walking.answer()?;
        let mut words = ready.split_whitespace().skip(1);
        let version = words.next().unwrap_or_default().to_owned();
        let time_step = words.next().and_then(|word| word.parse().ok());
        let time_step = time_step.ok_or_else(|| stopped(format!("it said {ready:?}")))?;
        Ok((walking, version, time_step))
    }

    fn answer(&mut self) -> Result<String, LabError> {
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(0) => Err(stopped("see its message above")),
            Ok(_) => Ok(line.trim().to_owned()),
            Err(error) => Err(stopped(error)),
        }
    }

    fn ms_per_step(&mut self, steps: u64) -> Result<f64, LabError> {
        writeln!(self.orders, "{steps}").map_err(stopped)?;
        let answer = self.answer()?;
        let seconds = answer.parse::<f64>();
        let seconds = seconds.map_err(|_| stopped(format!("it said {answer:?}")))?;
        Ok(1e3 * seconds / steps as f64)
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
