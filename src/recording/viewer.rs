//! A running viewer as rerun's messages go there.

use std::fmt;
use std::net::{TcpStream, ToSocketAddrs};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rerun::external::re_log_types::StoreKind;
use rerun::external::re_uri::ProxyUri;
use rerun::log::LogMsg;
use rerun::sink::{GrpcSink, LogSink, SinkFlushError};
use rerun::{DEFAULT_SERVER_PORT, SpawnError, SpawnOptions};

use super::error::RecordingError;
use super::file::Failure;

/// What does not answer within this time is not there.
const PATIENCE: Duration = Duration::from_secs(3);

/// Which viewer shows a run while it goes on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Viewer {
    /// The one that listens on rerun's own port of this machine, started if there is none.
    Spawned,
    /// One that is there already.
    At(Address),
}

/// The address of a running viewer: `rerun+http://HOST:PORT/proxy`, or `HOST:PORT` or `HOST` for short.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address(ProxyUri);

/// A text is no address of a viewer.
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

impl Viewer {
    /// The way to this viewer, once it answers.
    pub(super) fn connect(&self) -> Result<ViewerSink, RecordingError> {
        let address = match self {
            Self::Spawned => spawn()?,
            Self::At(address) => address.clone(),
        };
        let origin = &address.0.origin;
        let (host, port) = (origin.format_host(), origin.port);
        let no_viewer = |reason: String| RecordingError::NoViewer {
            address: address.to_string(),
            reason,
        };
        let mut places = (host.trim_matches(['[', ']']), port)
            .to_socket_addrs()
            .map_err(|error| no_viewer(error.to_string()))?;
        let mut refusal = "no such host".to_owned();
        let answers = places.any(|place| {
            let answer = TcpStream::connect_timeout(&place, PATIENCE);
            answer.map_err(|error| refusal = error.to_string()).is_ok()
        });
        if !answers {
            return Err(no_viewer(refusal));
        }
        Ok(ViewerSink {
            stream: GrpcSink::new(address.0.clone()),
            failure: Failure::default(),
            has_layout: AtomicBool::new(false),
        })
    }
}

/// Starts a viewer, unless one runs already.
fn spawn() -> Result<Address, RecordingError> {
    let options = SpawnOptions {
        wait_for_bind: true,
        // It shares our stderr.
        extra_env: vec![("RUST_LOG".to_owned(), "error".to_owned())],
        ..SpawnOptions::default()
    };
    let viewer = rerun::spawn(&options).map_err(|error| RecordingError::NotSpawned {
        reason: match error {
            SpawnError::Io(error) => error.to_string(),
            SpawnError::ExecutableNotFound { .. } | SpawnError::ExecutableNotFoundInPath { .. } => {
                "no program `rerun` was found; `pip install rerun-sdk==0.36.3` brings it".to_owned()
            }
        },
    })?;
    let address = format!("127.0.0.1:{}", viewer.port);
    address
        .parse()
        .map_err(|error: AddressError| RecordingError::NotSpawned {
            reason: error.to_string(),
        })
}

/// A viewer at the other end of a connection. That it goes away fails nothing: it is closed by whoever has
/// seen enough.
pub struct ViewerSink {
    stream: GrpcSink,
    failure: Failure,
    /// The layout of a file's end is not for who has watched, and moved it.
    has_layout: AtomicBool,
}

impl ViewerSink {
    /// How it went away, to be looked at while the sink is used and when it is gone.
    pub fn failure(&self) -> Failure {
        self.failure.clone()
    }
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
        self.stream.send(message);
    }

    fn flush_blocking(&self, timeout: Duration) -> Result<(), SinkFlushError> {
        if let Err(error) = self.stream.flush_blocking(timeout) {
            self.failure.is(&error);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_whole_or_a_host_and_a_port() {
        let address = |text: &str| text.parse::<Address>().map(|address| address.to_string());
        let whole = "rerun+http://127.0.0.1:9876/proxy".to_owned();
        assert_eq!(address(&whole), Ok(whole.clone()));
        assert_eq!(address("127.0.0.1:9876"), Ok(whole.clone()));
        assert_eq!(address("127.0.0.1"), Ok(whole));
        assert_eq!(
            address("[::1]:9876"),
            Ok("rerun+http://[::1]:9876/proxy".to_owned())
        );
        for wrong in [
            "",
            "http://",
            "ftp://127.0.0.1:1/proxy",
            "host:port",
            "a b:1",
        ] {
            assert_eq!(address(wrong), Err(AddressError), "{wrong}");
        }
    }
}
