//! Health and verdicts of lines, as they are told.

use core::{
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

use serde_json::{Map, Value, json};
use tokio::{
    task::yield_now,
    time::{Instant, sleep},
};

use super::hub::{Desk, Hub};

/// From one look at the counts of all lines to the next.
const PAUSE: Duration = Duration::from_secs(5);

/// From one look at a line to the next, in times of what it took.
const REST: u32 = 10;

/// Retains health and verdict of every line, where they have changed.
pub(crate) async fn run(hub: &Hub) {
    tokio::join!(retain_health(hub), look(hub));
}

async fn retain_health(hub: &Hub) {
    loop {
        for (line, desk) in &hub.lines {
            hub.retain_health(line, health(desk).to_string());
            // The stations of all lines answer meanwhile.
            yield_now().await;
        }
        sleep(PAUSE).await;
    }
}

/// Looks at the lines in turn. A gateway that has too little of its computer answers late, which
/// its stations count as faults: looks at all of them must not take what is left.
async fn look(hub: &Hub) {
    loop {
        for (line, desk) in &hub.lines {
            let begin = Instant::now();
            if let Some(diagnosis) = desk.tap.news(desk.counts.faults.total()) {
                hub.retain_verdict(line, diagnosis);
            }
            yield_now().await;
            sleep(begin.elapsed() * REST).await;
        }
        sleep(PAUSE).await;
    }
}

fn health(desk: &Desk) -> Value {
    let counts = &desk.counts;
    let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
    let faults = counts.faults.counts().filter(|(_, count)| *count > 0);
    let faults: Map<_, _> = faults
        .map(|(name, count)| (name.to_owned(), json!(count)))
        .collect();
    json!({
        "received": of(&counts.received),
        "possible_repeats": of(&counts.repeats),
        "not_stored": of(&counts.not_stored),
        "dead_letters": of(&counts.dead),
        "commands_done": of(&counts.done),
        "commands_failed": of(&counts.failed),
        "opened": of(&counts.opened),
        "faults": faults,
        "last_fault": counts.faults.last(),
    })
}
