//! One request: checked, read, answered.

use super::Server;
use super::assets::{ASSETS, PAGE};
use super::jobs::Job;
use crate::engine::{Refusal, Request, answer};
use crate::respond::Response as Answer;
use http_body_util::{BodyExt, Full, LengthLimitError, Limited};
use hyper::body::{Body, Bytes, Incoming};
use hyper::header::{
    ALLOW, CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, HeaderValue,
    REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use hyper::{Method, Response, StatusCode};
use serde::Serialize;
use serde_json::{Value, json};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

/// Longest body: an experiment is some kilobytes, a recording in base64 the rest.
const MOST_BYTES: u64 = 96 * 1024 * 1024;

/// Longest time in which a body may come, and an answer be computed; a fit may take longer.
const BODY: Duration = Duration::from_secs(30);
const ANSWER: Duration = Duration::from_secs(120);
const FIT: Duration = Duration::from_secs(3600);

/// Nothing from elsewhere, no script or style but the page's files; pictures that it made itself.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
     img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

type Page = Response<Full<Bytes>>;

/// Returns the response to any request.
pub(super) async fn respond(
    server: Arc<Server>,
    request: hyper::Request<Incoming>,
) -> Result<Page, Infallible> {
    Ok(route(&server, request).await)
}

async fn route(server: &Server, request: hyper::Request<Incoming>) -> Page {
    if !server.guard.is_local(request.headers()) {
        return refused(StatusCode::FORBIDDEN, "this server answers its own page alone");
    }
    let path = request.uri().path().to_owned();
    match (request.method(), path.as_str()) {
        (&Method::GET, "/") if server.guard.opens(request.uri()) => {
            page("text/html; charset=utf-8", PAGE)
        }
        (&Method::GET, "/") => refused(
            StatusCode::FORBIDDEN,
            "open the page by the whole address that `hertzchain explore` printed, with its token",
        ),
        (&Method::GET, path) => match ASSETS.iter().find(|asset| asset.path == path) {
            Some(asset) => page(asset.kind, asset.text),
            None => refused(StatusCode::NOT_FOUND, "there is no such file"),
        },
        (&Method::POST, "/start" | "/answer" | "/progress" | "/cancel") => {
            api(server, request, &path).await
        }
        _ => {
            let mut response = refused(StatusCode::METHOD_NOT_ALLOWED, "expected GET or POST");
            let allowed = HeaderValue::from_static("GET, POST");
            response.headers_mut().insert(ALLOW, allowed);
            response
        }
    }
}

/// The engine: all of it needs the token.
async fn api(server: &Server, request: hyper::Request<Incoming>, path: &str) -> Page {
    if !server.guard.has_token(request.headers()) {
        return refused(
            StatusCode::FORBIDDEN,
            "the token is missing or wrong: open the page again by the address that `hertzchain explore` printed",
        );
    }
    let lane = request.uri().query().unwrap_or_default();
    let lane = lane.strip_prefix("lane=").unwrap_or("page").to_owned();
    match path {
        "/start" => done(&json!({
            "experiment": server.experiment,
            "version": env!("CARGO_PKG_VERSION"),
        })),
        "/progress" => {
            let stop = server.jobs.of_lane(&lane);
            done(&json!(stop.map(|stop| json!({
                "done": stop.done(), "steps": stop.steps(), "note": stop.note(),
            }))))
        }
        "/cancel" => {
            let stop = server.jobs.of_lane(&lane);
            if let Some(stop) = &stop {
                stop.ask();
            }
            done(&json!(stop.is_some()))
        }
        _ => compute(server, request, &lane).await,
    }
}

async fn compute(server: &Server, request: hyper::Request<Incoming>, lane: &str) -> Page {
    let is_json = request.headers().get(CONTENT_TYPE);
    if is_json.is_none_or(|kind| kind != "application/json") {
        return refused(StatusCode::UNSUPPORTED_MEDIA_TYPE, "expected application/json");
    }
    let body = match body(request).await {
        Ok(body) => body,
        Err(response) => return response,
    };
    let request: Request = match serde_json::from_slice(&body) {
        Ok(request) => request,
        Err(error) => return failed(StatusCode::BAD_REQUEST, Refusal::unread(error)),
    };
    drop(body);
    let Some(job) = server.jobs.enter(lane) else {
        return refused(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many requests are waiting: wait until some have been answered",
        );
    };
    let longest = match request {
        Request::Fit { .. } => FIT,
        _ => ANSWER,
    };
    let answered = tokio::time::timeout(longest, run(server, &job, request)).await;
    done(&Answer::from(answered.unwrap_or_else(|_| {
        let text = format!("the answer took more than {longest:?} and was given up");
        Err(Refusal::Error(text))
    })))
}

/// Answers on a thread of its own, so that this one goes on serving.
async fn run(server: &Server, job: &Job<'_>, request: Request) -> Result<Value, Refusal> {
    let Some(place) = job.turn().await else {
        return Err(Refusal::Stopped);
    };
    let (verbs, stop) = (server.verbs.clone(), job.stop.clone());
    let answered = tokio::task::spawn_blocking(move || {
        let answered = answer(&request, &*verbs, &stop);
        // Only now: work that was asked to stop still has its core until it has.
        drop(place);
        answered
    });
    answered.await.unwrap_or_else(|error| {
        Err(Refusal::Error(format!("the engine failed, which is a bug: {error}")))
    })
}

async fn body(request: hyper::Request<Incoming>) -> Result<Bytes, Page> {
    let too_long = || {
        let text = format!("the request is longer than {} MB", MOST_BYTES >> 20);
        refused(StatusCode::PAYLOAD_TOO_LARGE, &text)
    };
    if request.body().size_hint().lower() > MOST_BYTES {
        return Err(too_long());
    }
    let body = Limited::new(request.into_body(), MOST_BYTES as usize).collect();
    match tokio::time::timeout(BODY, body).await {
        Ok(Ok(body)) => Ok(body.to_bytes()),
        Ok(Err(error)) if error.is::<LengthLimitError>() => Err(too_long()),
        _ => Err(refused(StatusCode::REQUEST_TIMEOUT, "the request did not come whole")),
    }
}

fn page(kind: &'static str, text: &'static str) -> Page {
    response(StatusCode::OK, kind, Bytes::from_static(text.as_bytes()))
}

fn done(reply: &impl Serialize) -> Page {
    json_of(StatusCode::OK, reply)
}

fn refused(status: StatusCode, why: &str) -> Page {
    failed(status, Refusal::Error(why.to_owned()))
}

fn failed(status: StatusCode, refusal: Refusal) -> Page {
    json_of(status, &Answer::Refused(refusal))
}

fn json_of(status: StatusCode, of: &impl Serialize) -> Page {
    let bytes = serde_json::to_vec(of).expect("texts, numbers and lists of them are JSON");
    response(status, "application/json", bytes.into())
}

fn response(status: StatusCode, kind: &'static str, body: Bytes) -> Page {
    let mut response = Response::new(Full::new(body));
    *response.status_mut() = status;
    let opener = HeaderName::from_static("cross-origin-opener-policy");
    let resource = HeaderName::from_static("cross-origin-resource-policy");
    let headers = [
        (CONTENT_TYPE, kind),
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
        (opener, "same-origin"),
        (resource, "same-origin"),
    ];
    for (name, value) in headers {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}
