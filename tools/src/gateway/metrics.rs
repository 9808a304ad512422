//! Counts for Prometheus, over HTTP.

use alloc::sync::Arc;
use core::{convert::Infallible, sync::atomic::Ordering, time::Duration};

use bytes::Bytes;
use http_body_util::Full;
use hyper::{
    Method, Request, Response, StatusCode, body::Incoming, header::CONTENT_TYPE,
    server::conn::http1, service::service_fn,
};
use hyper_util::rt::{TokioIo, TokioTimer};
use log::debug;
use tokio::net::TcpListener;

use super::{
    accept,
    hub::{Desk, Hub},
};

/// How long a client may take for its request.
const PATIENCE: Duration = Duration::from_secs(10);

/// Serves `GET /metrics` until the gateway ends.
pub(crate) async fn serve(listener: TcpListener, hub: Arc<Hub>) {
    loop {
        let (stream, _) = accept(&listener, "metrics").await;
        let hub = Arc::clone(&hub);
        tokio::spawn(async move {
            let answer = service_fn(|request| {
                let answer = answer(&request, &hub);
                async { Ok::<_, Infallible>(answer) }
            });
            let served = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(PATIENCE)
                .keep_alive(false)
                .serve_connection(TokioIo::new(stream), answer);
            if let Err(error) = served.await {
                debug!("metrics: {error}");
            }
        });
    }
}

fn answer(request: &Request<Incoming>, hub: &Hub) -> Response<Full<Bytes>> {
    let is_asked = request.method() == Method::GET && request.uri().path() == "/metrics";
    let text = if is_asked { text(hub) } else { String::new() };
    let mut answer = Response::new(Full::from(text));
    if !is_asked {
        *answer.status_mut() = StatusCode::NOT_FOUND;
    }
    let kind = hyper::header::HeaderValue::from_static("text/plain; version=0.0.4");
    answer.headers_mut().insert(CONTENT_TYPE, kind);
    answer
}

/// One metric: name, type, help, and how it is read from a line.
type OfLine = (&'static str, &'static str, &'static str, fn(&Desk) -> u64);

const OF_LINES: [OfLine; 7] = [
    (
        "line_up",
        "gauge",
        "1 while the port is open and the last exchange went well",
        |desk| desk.is_online().into(),
    ),
    (
        "line_opened_total",
        "counter",
        "times that the port was opened",
        |desk| desk.counts.opened.load(Ordering::Relaxed),
    ),
    (
        "line_received_total",
        "counter",
        "telegrams and areas received",
        |desk| desk.counts.received.load(Ordering::Relaxed),
    ),
    (
        "line_possible_repeats_total",
        "counter",
        "telegrams that may be repeats",
        |desk| desk.counts.repeats.load(Ordering::Relaxed),
    ),
    (
        "line_commands_done_total",
        "counter",
        "commands that were done",
        |desk| desk.counts.done.load(Ordering::Relaxed),
    ),
    (
        "line_commands_failed_total",
        "counter",
        "commands that failed on the line",
        |desk| desk.counts.failed.load(Ordering::Relaxed),
    ),
    (
        "line_commands_refused_total",
        "counter",
        "commands that were not begun",
        |desk| desk.counts.refused.load(Ordering::Relaxed),
    ),
];

fn text(hub: &Hub) -> String {
    let mut text = String::new();
    for (name, kind, help, value) in OF_LINES {
        head(&mut text, name, kind, help);
        for (line, desk) in &hub.lines {
            let value = value(desk);
            text.push_str(&format!("line3964r_{name}{{line=\"{line}\"}} {value}\n"));
        }
    }
    if let Some(outbox) = &hub.outbox {
        let broker = &hub.broker;
        let queued = u64::try_from(outbox.len()).unwrap_or(u64::MAX);
        let load = |count: &core::sync::atomic::AtomicU64| count.load(Ordering::Relaxed);
        let is_connected = broker.is_connected.load(Ordering::Relaxed);
        for (name, kind, help, value) in [
            (
                "mqtt_connected",
                "gauge",
                "1 while connected",
                is_connected.into(),
            ),
            (
                "mqtt_connects_total",
                "counter",
                "connections made",
                load(&broker.connects),
            ),
            (
                "mqtt_published_total",
                "counter",
                "messages acknowledged",
                load(&broker.published),
            ),
            (
                "mqtt_refused_total",
                "counter",
                "messages refused by the broker",
                load(&broker.refused),
            ),
            (
                "mqtt_queue",
                "gauge",
                "messages without an acknowledgement",
                queued,
            ),
            (
                "mqtt_dropped_total",
                "counter",
                "messages given up, the queue was full",
                outbox.dropped(),
            ),
        ] {
            head(&mut text, name, kind, help);
            text.push_str(&format!("line3964r_{name} {value}\n"));
        }
    }
    text
}

fn head(text: &mut String, name: &str, kind: &str, help: &str) {
    text.push_str(&format!(
        "# HELP line3964r_{name} {help}\n# TYPE line3964r_{name} {kind}\n"
    ));
}
