//! Sends rerun's messages to a running viewer.

use std::fmt;
use std::net::{TcpStream, ToSocketAddrs};
use std::str::FromStr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rerun::external::re_log_types::StoreKind;
use rerun::external::re_uri::ProxyUri;
use rerun::log::LogMsg;
use rerun::sink::{GrpcSink, LogSink, SinkFlushError};
use rerun::{DEFAULT_SERVER_PORT, SpawnError, SpawnOptions};

use super::file::Failure;
use super::relay::{GivenUp, Items, Relay};
use crate::recording::error::RecordingError;

/// Timeout for connecting to a viewer.
const CONNECTING: Duration = Duration::from_secs(3);
/// A viewer that takes no data for this long, while the run waits for it, gets no more data.
const PATIENCE: Duration = Duration::from_secs(2);

/// The viewer that shows a run live.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Viewer {
    /// The viewer on rerun's default port of this machine; started if none is running.
    Spawned,
    /// A running viewer.
    At(Address),
}

/// The address of a running viewer: `rerun+http://HOST:PORT/proxy`, or `HOST:PORT` or `HOST` for short.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address(ProxyUri);

/// A text is not the address of a viewer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no address of a viewer: rerun+http://HOST:PORT/proxy or HOST:PORT is needed")]
pub struct AddressError;

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let whole = if text.contains("://") {
            text.to_owned()
        } else if text.ends_with(|last: char| last.is_ascii_digit()) && text.contains(':') {
            format!("rerun+http://{text}/proxy")
        } else {
            format!("rerun+http://{text}:{DEFAULT_SERVER_PORT}/proxy")
        };
        whole.parse().map(Self).map_err(|_| AddressError)
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Address {
    /// No viewer answers here.
    fn silent(&self, reason: String) -> RecordingError {
        RecordingError::NoViewer {
            address: self.to_string(),
            reason,
        }
    }
}

impl Viewer {
    /// The address of the viewer, which answers; it is started if it is to be.
    ///
    /// # Errors
    /// No viewer answers, or none can be started.
    pub fn reached(&self) -> Result<Address, RecordingError> {
        let address = match self {
            Self::Spawned => spawn()?,
            Self::At(address) => address.clone(),
        };
        let origin = &address.0.origin;
        let (host, port) = (origin.format_host(), origin.port);
        let no_viewer = |reason: String| address.silent(reason);
        let mut places = (host.trim_matches(['[', ']']), port)
            .to_socket_addrs()
            .map_err(|error| no_viewer(error.to_string()))?;
        let mut refusal = "no such host".to_owned();
        let answers = places.any(|place| {
            let answer = TcpStream::connect_timeout(&place, CONNECTING);
            answer.map_err(|error| refusal = error.to_string()).is_ok()
        });
        match answers {
            true => Ok(address),
            false => Err(no_viewer(refusal)),
        }
    }

    /// Connects to the viewer, once it answers.
    pub(super) fn connect(
        &self,
        interrupted: &Arc<AtomicBool>,
    ) -> Result<ViewerSink, RecordingError> {
        let address = self.reached()?;
        let opened = ViewerSink::open(address.clone(), Arc::clone(interrupted));
        opened.map_err(|error| address.silent(error.to_string()))
    }
}

/// Starts a viewer, unless one is already running.
fn spawn() -> Result<Address, RecordingError> {
    let reason = |error| match error {
        SpawnError::Io(error) => error.to_string(),
        SpawnError::ExecutableNotFound { .. } | SpawnError::ExecutableNotFoundInPath { .. } => {
            "no program `rerun` was found; `pip install rerun-sdk==0.36.3` brings it".to_owned()
        }
    };
    let spawned = rerun::spawn(&spawn_options());
    let viewer = spawned.map_err(|error| RecordingError::NotSpawned(reason(error)))?;
    let address = format!("127.0.0.1:{}", viewer.port).parse();
    address.map_err(|error: AddressError| RecordingError::NotSpawned(error.to_string()))
}

/// A new viewer listens only on this machine's loopback address; rerun's default is all addresses.
fn spawn_options() -> SpawnOptions {
    SpawnOptions {
        wait_for_bind: true,
        extra_args: ["--bind", "127.0.0.1"].map(str::to_owned).to_vec(),
        // The viewer shares our stderr.
        extra_env: vec![("RUST_LOG".to_owned(), "error".to_owned())],
        ..SpawnOptions::default()
    }
}

/// A connected viewer, fed by its own thread: rerun's sink waits forever for a viewer that accepts the connection
/// but reads nothing. The run goes on when the viewer is gone.
pub struct ViewerSink {
    relay: Relay<LogMsg>,
    pub address: Address,
    pub failure: Failure,
    /// Whether the viewer has a layout. The final layout, meant for the file, would undo changes by the viewer's user.
    has_layout: AtomicBool,
}

impl ViewerSink {
    fn open(address: Address, interrupted: Arc<AtomicBool>) -> std::io::Result<Self> {
        let (relay, items) = Relay::new(PATIENCE, interrupted);
        let uri = address.0.clone();
        let failure = Failure::default();
        let seen = failure.clone();
        // Never joined, because it may wait for the viewer until the process ends.
        std::thread::Builder::new()
            .name("viewer".to_owned())
            .spawn(move || feed(items, GrpcSink::new(uri), &seen))?;
        Ok(Self {
            relay,
            address,
            failure,
            has_layout: AtomicBool::new(false),
        })
    }

    fn give_up(&self, GivenUp(after): &GivenUp) {
        let secs = after.as_secs_f64();
        let reason = format!("it took no data for {secs} s");
        self.failure.set(reason).ok();
    }
}

/// Forwards all messages, then waits until the viewer confirms the end of the data.
fn feed(mut items: Items<LogMsg>, stream: GrpcSink, failure: &Failure) {
    for message in items.by_ref() {
        stream.send(message);
        // Without this flush, messages would wait in rerun's own queue, whose progress we cannot see.
        if let Err(error) = stream.flush_blocking(Duration::MAX) {
            failure.set(error.to_string()).ok();
            break;
        }
    }
    drop(stream);
    drop(items);
}

impl LogSink for ViewerSink {
    fn send(&self, message: LogMsg) {
        let is_layout = message.store_id().kind() == StoreKind::Blueprint;
        if is_layout && self.has_layout.load(Ordering::Relaxed) {
            return;
        }
        if matches!(message, LogMsg::BlueprintActivationCommand(_)) {
            self.has_layout.store(true, Ordering::Relaxed);
        }
        if let Err(given_up) = self.relay.send(message) {
            self.give_up(&given_up);
        }
    }

    /// Does not wait: messages keep their order, and dropping the sink waits for them.
    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        Ok(())
    }
}

impl Drop for ViewerSink {
    /// Waits for the viewer as long as it takes data.
    fn drop(&mut self) {
        if let Err(given_up) = self.relay.close() {
            self.give_up(&given_up);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_started_viewer_listens_on_this_machine_only() {
        let options = spawn_options();
        assert_eq!(options.extra_args, ["--bind", "127.0.0.1"]);
    }
}
