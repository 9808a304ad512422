//! Counts for Prometheus, and what lines carried for Wireshark, over HTTP.

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
use tokio::{
    net::TcpListener,
    task::{JoinSet, spawn_blocking},
};

use super::{
    accept,
    hub::{Desk, Hub},
};

/// Clients at once; others wait for them, and take no file from a line.
const MAX_CLIENTS: usize = 8;

/// How long a client may take for its request.
const PATIENCE: Duration = Duration::from_secs(10);

/// Serves `GET /metrics` and `GET /capture/LINE.pcapng` until the gateway ends.
pub(crate) async fn serve(listener: TcpListener, hub: Arc<Hub>) {
    let mut clients = JoinSet::new();
    loop {
        let stream = tokio::select! {
            (stream, _) = accept(&listener, "metrics"), if clients.len() < MAX_CLIENTS => stream,
            Some(_) = clients.join_next() => continue,
        };
        let hub = Arc::clone(&hub);
        clients.spawn(async move {
            let answer = service_fn(|request| {
                let hub = Arc::clone(&hub);
                async move { Ok::<_, Infallible>(answer(&request, &hub).await) }
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

async fn answer(request: &Request<Incoming>, hub: &Hub) -> Response<Full<Bytes>> {
    let path = match *request.method() {
        Method::GET => request.uri().path(),
        _ => "",
    };
    let found = if path == "/metrics" {
        Some((Bytes::from(text(hub)), "text/plain; version=0.0.4"))
    } else {
        let capture = capture(path, hub).await;
        capture.map(|bytes| (Bytes::from(bytes), "application/octet-stream"))
    };
    let is_found = found.is_some();
    let (body, kind) = found.unwrap_or((Bytes::new(), "text/plain"));
    let mut answer = Response::new(Full::from(body));
    if !is_found {
        *answer.status_mut() = StatusCode::NOT_FOUND;
    }
    let kind = hyper::header::HeaderValue::from_static(kind);
    answer.headers_mut().insert(CONTENT_TYPE, kind);
    answer
}

/// What a line carried last; in a thread of its own, since the lines go on meanwhile.
async fn capture(path: &str, hub: &Hub) -> Option<Vec<u8>> {
    let line = path.strip_prefix("/capture/")?.strip_suffix(".pcapng")?;
    let tap = Arc::clone(&hub.lines.get(line)?.tap);
    let made = spawn_blocking(move || tap.pcapng()).await;
    made.ok().flatten()
}

/// One metric: name, type, help, and how it is read from a line.
type OfLine = (&'static str, &'static str, &'static str, fn(&Desk) -> u64);

const OF_LINES: [OfLine; 11] = [
    (
        "line_up",
        "gauge",
        "1 while the port is open, the last exchange went well, and the line is not silent",
        |desk| desk.is_online().into(),
    ),
    (
        "line_verdict_is_fault",
        "gauge",
        "1 while the verdict on the line names a fault",
        |desk| desk.tap.is_fault().into(),
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
    (
        "line_verdict_us_total",
        "counter",
        "microseconds that verdicts have taken",
        |desk| desk.tap.taken_us(),
    ),
    (
        "line_not_stored_total",
        "counter",
        "telegrams answered NAK because they could not be made safe",
        |desk| desk.counts.not_stored.load(Ordering::Relaxed),
    ),
    (
        "line_dead_letters_total",
        "counter",
        "messages that the broker refused",
        |desk| desk.counts.dead.load(Ordering::Relaxed),
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
    let faults = "line_faults_total";
    head(
        &mut text,
        faults,
        "counter",
        "what went wrong on the line, by its cause",
    );
    for (line, desk) in &hub.lines {
        for (fault, count) in desk.counts.faults.counts() {
            text.push_str(&format!(
                "line3964r_{faults}{{line=\"{line}\",fault=\"{fault}\"}} {count}\n"
            ));
        }
    }
    if let Some(outbox) = &hub.outbox {
        let broker = &hub.broker;
        let load = |count: &core::sync::atomic::AtomicU64| count.load(Ordering::Relaxed);
        let kind_of_broker = hub.broker_kind;
        let is_connected = broker.is_connected.load(Ordering::Relaxed);
        for (name, kind, help, value) in [
            (
                &*format!("{kind_of_broker}_connected"),
                "gauge",
                "1 while connected",
                is_connected.into(),
            ),
            (
                &*format!("{kind_of_broker}_connects_total"),
                "counter",
                "connections made",
                load(&broker.connects),
            ),
            (
                &*format!("{kind_of_broker}_published_total"),
                "counter",
                "messages acknowledged",
                load(&broker.published),
            ),
            (
                &*format!("{kind_of_broker}_refused_total"),
                "counter",
                "messages refused by the broker",
                load(&broker.refused),
            ),
            (
                &*format!("{kind_of_broker}_queue"),
                "gauge",
                "messages without an acknowledgement",
                outbox.len(),
            ),
            (
                "store_bytes",
                "gauge",
                "bytes of the messages in the store",
                outbox.bytes(),
            ),
            (
                "dead_letters_total",
                "counter",
                "messages in the file of dead letters since the start",
                outbox.dead(),
            ),
            (
                &*format!("{kind_of_broker}_dropped_total"),
                "counter",
                "messages given up, there was no room",
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
