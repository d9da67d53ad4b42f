//! The server: on the loopback address alone, for requests that have the token.

use std::ffi::OsString;
use std::io::Read;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use output::recording::{RecordingError, Viewer};
use serde_json::Value;
use tiny_http::{Header, Method, Response};

use crate::answer::{Answer, Refusal};
use crate::drawing;
use crate::drawings::Drawings;
use crate::plays::Plays;
use crate::requests::{Answers, Request};
use runs::case::Source;

/// The number of requests that are answered at a time: those for frames wait.
const THREADS: usize = 16;
/// The longest content of a request, bytes.
const LONGEST: u64 = 64 << 20;
/// The time between two looks at whether the server shall end.
const LOOK: Duration = Duration::from_millis(100);
/// Headers of every answer: pages are not kept, not shown within others, and tell no other server their address.
const HEADERS: [(&str, &str); 5] = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "DENY"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
];

/// What a studio needs.
pub struct Studio {
    /// The scenario that it opens first.
    pub scenario: Option<Source>,
    /// The port; `None`: a free one.
    pub port: Option<u16>,
    /// Main memory for a run, bytes; `None`: no limit.
    pub memory: Option<u64>,
    /// A Rerun viewer that shows the runs, too.
    pub viewer: Option<Viewer>,
    /// The program, and its first arguments: it makes recordings, pages, reports and pictures.
    pub program: Vec<OsString>,
}

/// Why the server does not start.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// The scenario cannot be opened.
    #[error("{0}")]
    Scenario(String),
    /// No viewer answers, or none can be started.
    #[error(transparent)]
    Viewer(#[from] RecordingError),
    /// The port is taken, or forbidden.
    #[error("port {port}: {cause}; give another one with --port")]
    Port {
        /// The port.
        port: u16,
        /// The reason.
        cause: String,
    },
}

/// A server that answers requests until it is dropped.
pub struct Server {
    http: Arc<tiny_http::Server>,
    address: SocketAddr,
    token: String,
}

impl Server {
    /// Starts the server.
    ///
    /// # Errors
    /// The scenario cannot be read, no viewer answers, or the port is taken.
    pub fn start(studio: Studio) -> Result<Self, ServerError> {
        let given = studio.scenario.as_ref().map(given).transpose()?;
        let viewer = studio.viewer.as_ref().map(Viewer::reached);
        let port = studio.port.unwrap_or(0);
        let failed = |cause: String| ServerError::Port { port, cause };
        let answers = Answers {
            given,
            memory: studio.memory,
            viewer: viewer.transpose()?,
            program: studio.program,
            drawings: Drawings::default(),
            plays: Plays::default(),
        };
        let opened = tiny_http::Server::http((Ipv4Addr::LOCALHOST, port));
        let http = Arc::new(opened.map_err(|error| failed(error.to_string()))?);
        let address = http.server_addr().to_ip();
        let server = Self {
            address: address.ok_or_else(|| failed("it is no address of the network".to_owned()))?,
            http,
            token: format!("{:032x}", rand::random::<u128>()),
        };
        let gate = Arc::new(Gate {
            answers,
            token: server.token.clone(),
            hosts: ["127.0.0.1", "localhost"]
                .map(|host| format!("{host}:{}", server.address.port())),
        });
        for _ in 0..THREADS {
            let (http, gate) = (server.http.clone(), gate.clone());
            let thread = std::thread::Builder::new().name("requests".to_owned());
            let started = thread.spawn(move || {
                while let Ok(request) = http.recv() {
                    gate.answer(request);
                }
            });
            started.map_err(|error| failed(error.to_string()))?;
        }
        Ok(server)
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }

    /// Answers requests until this returns true.
    pub fn run(self, is_over: impl Fn() -> bool) {
        while !is_over() {
            std::thread::sleep(LOOK);
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        for _ in 0..THREADS {
            self.http.unblock();
        }
    }
}

/// The document of the scenario on the command line.
fn given(source: &Source) -> Result<Value, ServerError> {
    let whole = rayon::scope(|_| drawing::whole(source));
    let (document, _) = whole.map_err(|refusal| ServerError::Scenario(refusal.message))?;
    Ok(document)
}

/// Lets those requests in that may come in.
struct Gate {
    answers: Answers,
    token: String,
    hosts: [String; 2],
}

impl Gate {
    fn answer(&self, mut request: tiny_http::Request) {
        let answer = self
            .checked(&mut request)
            .unwrap_or_else(|refusal| refusal.answer());
        let kind = [("Content-Type", answer.kind)];
        let all = HEADERS.iter().copied().chain(kind);
        let headers = all.filter_map(|(name, value)| Header::from_bytes(name, value).ok());
        let file = answer.file.as_ref().and_then(|file| {
            Header::from_bytes(
                "Content-Disposition",
                format!("attachment; filename=\"{file}\""),
            )
            .ok()
        });
        let mut response = Response::from_data(answer.content).with_status_code(answer.status);
        headers
            .chain(file)
            .for_each(|header| response.add_header(header));
        // A page that has gone needs no answer.
        request.respond(response).ok();
    }

    fn checked(&self, request: &mut tiny_http::Request) -> Result<Answer, Refusal> {
        self.check_origin(request)?;
        let address = request.url().to_owned();
        let (path, query) = address.split_once('?').unwrap_or((&address, ""));
        let inside = path
            .strip_prefix('/')
            .and_then(|path| path.strip_prefix(self.token.as_str()));
        let path = inside
            .and_then(|path| path.strip_prefix('/'))
            .ok_or_else(|| {
                Refusal::with(
                    403,
                    "the address lacks the token; take the address that the program has printed",
                )
            })?;
        let is_post = match request.method() {
            Method::Get => false,
            Method::Post => true,
            _ => return Err(Refusal::with(405, "only GET and POST are answered")),
        };
        let mut body = Vec::new();
        let read = request.as_reader().take(LONGEST + 1).read_to_end(&mut body);
        read.map_err(|error| Refusal::wrong(format!("the request: {error}")))?;
        if body.len() as u64 > LONGEST {
            return Err(Refusal::with(
                413,
                format!("the request has more than {} MB", LONGEST >> 20),
            ));
        }
        let asked = Request {
            is_post,
            path,
            query,
            body: &body,
        };
        Ok(self.answers.to(&asked))
    }

    /// Refuses requests under another name of this machine, and those of pages from elsewhere.
    fn check_origin(&self, request: &tiny_http::Request) -> Result<(), Refusal> {
        let value = |name: &'static str| {
            let mut all = request.headers().iter();
            all.find(|header| header.field.equiv(name))
                .map(|header| header.value.as_str().to_owned())
        };
        let is_own = |host: &str| self.hosts.iter().any(|own| own == host);
        if !value("Host").is_some_and(|host| is_own(&host)) {
            return Err(Refusal::with(
                403,
                "the server answers on 127.0.0.1 and localhost only",
            ));
        }
        let origin = value("Origin");
        let is_other = |origin: &String| !origin.strip_prefix("http://").is_some_and(is_own);
        let is_foreign =
            value("Sec-Fetch-Site").is_some_and(|site| site != "same-origin" && site != "none");
        if origin.as_ref().is_some_and(is_other) || is_foreign {
            return Err(Refusal::with(
                403,
                "pages from elsewhere cannot use the studio",
            ));
        }
        Ok(())
    }
}
