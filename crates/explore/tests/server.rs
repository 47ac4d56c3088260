//! Who is answered, and who is not.

use crate::common::{Echo, text};
use hertzchain_explore::{Settings, serve};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// A server that runs until the tests end.
#[derive(Clone)]
struct Served {
    port: u16,
    token: String,
}

impl Served {
    fn start() -> Self {
        let (sender, receiver) = mpsc::channel();
        thread::spawn(move || {
            let opened = |address: &str| sender.send(address.to_owned()).unwrap();
            serve(Settings::default(), Arc::new(Echo), opened).unwrap();
        });
        let address = receiver.recv_timeout(Duration::from_secs(10)).unwrap();
        let (host, token) = address.split_once("/?token=").unwrap();
        let port = host.rsplit(':').next().unwrap().parse().unwrap();
        let token = token.to_owned();
        Self { port, token }
    }

    /// The response to a request that is written as given.
    fn raw(&self, request: &str) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut response = String::new();
        stream.read_to_string(&mut response).unwrap();
        response
    }

    fn headers(&self) -> Vec<(&'static str, String)> {
        vec![
            ("Host", format!("127.0.0.1:{}", self.port)),
            ("Origin", format!("http://127.0.0.1:{}", self.port)),
            ("X-Hertzchain-Token", self.token.clone()),
            ("Content-Type", "application/json".to_owned()),
        ]
    }

    /// The response to a request with these headers in place of its own; empty ones are left out.
    fn post(&self, path: &str, body: &str, changed: &[(&str, &str)]) -> String {
        let mut request = format!("POST {path} HTTP/1.1\r\nConnection: close\r\n");
        for (name, value) in self.headers() {
            let other = changed.iter().find(|(of, _)| *of == name);
            let value = other.map_or(value.as_str(), |(_, value)| value);
            if !value.is_empty() {
                request += &format!("{name}: {value}\r\n");
            }
        }
        self.raw(&format!("{request}Content-Length: {}\r\n\r\n{body}", body.len()))
    }

    fn get(&self, path: &str) -> String {
        let host = format!("Host: 127.0.0.1:{}", self.port);
        self.raw(&format!("GET {path} HTTP/1.1\r\n{host}\r\nConnection: close\r\n\r\n"))
    }
}

fn status(response: &str) -> u16 {
    response.split(' ').nth(1).unwrap().parse().unwrap()
}

fn body(response: &str) -> Value {
    serde_json::from_str(response.split_once("\r\n\r\n").unwrap().1).unwrap()
}

const PRESETS: &str = r#"{"verb":"presets"}"#;

#[test]
fn the_page_s_own_requests_are_answered() {
    let served = Served::start();
    let page = served.get(&format!("/?token={}", served.token));
    assert_eq!(status(&page), 200);
    assert!(page.contains("content-security-policy: default-src 'none'; script-src 'self'"));
    assert!(page.contains("x-content-type-options: nosniff"));
    assert_eq!(status(&served.get("/app.js")), 200);
    let answered = served.post("/answer?lane=a", PRESETS, &[]);
    assert_eq!(status(&answered), 200);
    assert_eq!(body(&answered)["reply"][0]["name"], "dry");
}

#[test]
fn whoever_has_no_token_is_refused() {
    let served = Served::start();
    assert_eq!(status(&served.get("/")), 403);
    assert_eq!(status(&served.get("/?token=")), 403);
    let wrong = "0".repeat(served.token.len());
    assert_eq!(status(&served.get(&format!("/?token={wrong}"))), 403);
    for token in ["", wrong.as_str()] {
        let changed = [("X-Hertzchain-Token", token)];
        assert_eq!(status(&served.post("/answer", PRESETS, &changed)), 403);
        assert_eq!(status(&served.post("/start", "", &changed)), 403);
        assert_eq!(status(&served.post("/cancel", "", &changed)), 403);
    }
}

#[test]
fn other_origins_and_other_names_of_this_machine_are_refused() {
    let served = Served::start();
    for origin in ["http://example.com", "null", "https://127.0.0.1", "http://127.0.0.1:1"] {
        let changed = [("Origin", origin)];
        assert_eq!(status(&served.post("/answer", PRESETS, &changed)), 403, "{origin}");
    }
    let rebound = format!("example.com:{}", served.port);
    let changed = [("Host", rebound.as_str()), ("Origin", "")];
    assert_eq!(status(&served.post("/answer", PRESETS, &changed)), 403);
}

#[test]
fn what_is_no_request_is_refused() {
    let served = Served::start();
    for text in ["", "{", "[]", r#"{"verb":"format-disk"}"#, r#"{"verb":"shot"}"#, "\u{0}"] {
        assert_eq!(status(&served.post("/answer", text, &[])), 400, "{text}");
    }
    let deep = "[".repeat(100_000);
    assert_eq!(status(&served.post("/answer", &deep, &[])), 400);
    let plain = [("Content-Type", "text/plain")];
    assert_eq!(status(&served.post("/answer", PRESETS, &plain)), 415);
    for path in ["/../Cargo.toml", "/..%2fCargo.toml", "/page/app.js", "/src/lib.rs"] {
        assert_eq!(status(&served.get(path)), 404, "{path}");
    }
}

#[test]
fn a_body_of_a_gigabyte_is_refused_before_it_comes() {
    let served = Served::start();
    let headers: String =
        served.headers().iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    let request = format!("POST /answer HTTP/1.1\r\n{headers}Content-Length: 1073741824\r\n\r\n");
    let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut head = [0; 12];
    stream.read_exact(&mut head).unwrap();
    assert_eq!(&head, b"HTTP/1.1 413");
}

#[test]
fn a_body_without_a_length_is_cut_off() {
    let served = Served::start();
    let headers: String =
        served.headers().iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    let request = format!("POST /answer HTTP/1.1\r\n{headers}Transfer-Encoding: chunked\r\n\r\n");
    let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let chunk = format!("100000\r\n{}\r\n", " ".repeat(1 << 20));
    let sent = (0..1024).take_while(|_| stream.write_all(chunk.as_bytes()).is_ok()).count();
    // 96 MB are taken, and what the sockets hold.
    assert!((96..200).contains(&sent), "{sent} MB");
    assert_eq!(status(&served.post("/answer?lane=a", PRESETS, &[])), 200);
}

fn fit() -> String {
    json!({ "verb": "fit", "text": text("dry"), "table": "", "options": {} }).to_string()
}

/// Starts a fit that ends only when it is stopped.
fn started(served: &Served) -> thread::JoinHandle<String> {
    let other = served.clone();
    let fit = thread::spawn(move || other.post("/answer?lane=fit", &fit(), &[]));
    let began = Instant::now();
    while body(&served.post("/progress?lane=fit", "", &[])).is_null() {
        assert!(began.elapsed() < Duration::from_secs(20));
        thread::sleep(Duration::from_millis(10));
    }
    fit
}

#[test]
fn a_fit_can_be_cancelled() {
    let served = Served::start();
    let fit = started(&served);
    assert_eq!(body(&served.post("/cancel?lane=fit", "", &[])), true);
    assert_eq!(body(&fit.join().unwrap())["refused"], "stopped");
}

#[test]
fn a_newer_request_of_a_lane_ends_the_one_before() {
    let served = Served::start();
    let fit = started(&served);
    assert_eq!(status(&served.post("/answer?lane=fit", PRESETS, &[])), 200);
    assert_eq!(body(&fit.join().unwrap())["refused"], "stopped");
}

#[test]
fn work_ends_when_its_page_goes_away() {
    let served = Served::start();
    // As many as may run at a time, each from a page that closes at once.
    for lane in 0..3 {
        let headers = served.headers();
        let headers: String =
            headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let fit = fit();
        let request = format!(
            "POST /answer?lane={lane} HTTP/1.1\r\n{headers}Content-Length: {}\r\n\r\n{fit}",
            fit.len()
        );
        let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(status(&served.post("/answer?lane=a", PRESETS, &[])), 200);
}
