//! The page's server: loopback only, for one user, until Ctrl-C.

mod assets;
mod guard;
mod jobs;
mod respond;

use crate::engine::Verbs;
use guard::Guard;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use jobs::Jobs;
use std::ffi::OsStr;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// What the page starts with, and where.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Port; chosen by the system when `None`.
    pub port: Option<u16>,
    /// Text of the experiment that the page shows first; the paper's dry row when `None`.
    pub experiment: Option<String>,
}

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// The port can't be listened on.
    #[error(
        "127.0.0.1:{port} can't be listened on: {error}; --port names another, none lets the system choose"
    )]
    Port {
        /// Port asked for; 0 for any.
        port: u16,
        /// Why.
        error: io::Error,
    },
    /// The system has no threads or no random numbers.
    #[error("the server can't start: {0}")]
    System(String),
}

/// Most connections at a time; browsers open six.
const MOST_CONNECTIONS: usize = 32;

/// Longest time in which the head of a request may come.
const HEAD: Duration = Duration::from_secs(10);

/// Everything that a connection needs.
struct Server {
    guard: Guard,
    jobs: Jobs,
    verbs: Arc<dyn Verbs>,
    experiment: Option<String>,
}

/// Opens an address in the user's browser.
///
/// # Errors
/// A system without a browser.
pub fn open(address: impl AsRef<OsStr>) -> io::Result<()> {
    ::open::that_detached(address)
}

/// Serves the page until the program ends, and calls `opened` with its address once it can be
/// opened.
///
/// # Errors
/// A port that can't be listened on.
pub fn serve(
    settings: Settings,
    verbs: Arc<dyn Verbs>,
    opened: impl FnOnce(&str),
) -> Result<(), ServerError> {
    let system = |error: &dyn std::fmt::Display| ServerError::System(error.to_string());
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|error| system(&error))?;
    runtime.block_on(async {
        let port = settings.port.unwrap_or(0);
        let refused = |error| ServerError::Port { port, error };
        let listener = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).await;
        let listener = listener.map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        let guard = Guard::new(port).map_err(|error| system(&error))?;
        let address = guard.address();
        let server = Arc::new(Server {
            guard,
            jobs: Jobs::default(),
            verbs,
            experiment: settings.experiment,
        });
        opened(&address);
        accept(&listener, &server).await;
        Ok(())
    })
}

async fn accept(listener: &TcpListener, server: &Arc<Server>) {
    let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let Ok(place) = places.clone().acquire_owned().await else {
            return;
        };
        let Ok((stream, _)) = listener.accept().await else {
            // Out of file descriptors, as after a burst: others end meanwhile.
            tokio::time::sleep(Duration::from_millis(50)).await;
            continue;
        };
        let server = server.clone();
        tokio::spawn(async move {
            let service = service_fn(|request| respond::respond(server.clone(), request));
            let connection = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(HEAD)
                .max_buf_size(64 * 1024)
                .serve_connection(TokioIo::new(stream), service);
            // A connection that breaks off is the browser's affair.
            drop(connection.await);
            drop(place);
        });
    }
}
