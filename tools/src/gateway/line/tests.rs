use alloc::sync::Arc;
use core::{future::pending, time::Duration};

use tokio::{
    join,
    sync::{mpsc::Receiver, oneshot},
    task::yield_now,
    time::timeout,
};

use super::refuse_until;
use crate::gateway::{
    config::Config,
    hub::Hub,
    job::Job,
    outbox::Outbox,
    store::{DeadLetters, Entry, Known, Message},
};

const CONFIG: &str = r#"
    name = "hall"
    [mqtt]
    broker = "mqtt://h"
    queue = 1
    [store]
    sync = "none"
    [[line]]
    name = "scale"
    port = "COM3"
    priority = "low"
"#;

fn hub() -> (Arc<Hub>, Receiver<Job>) {
    let config = Config::parse(CONFIG).unwrap();
    let mqtt = config.mqtt().unwrap();
    let letters = DeadLetters::new("unused".into(), 0);
    let outbox = Outbox::in_memory(mqtt.queue(), mqtt.overflow, letters).unwrap();
    let (hub, mut jobs) = Hub::new(&config, Some(outbox), Known::nothing());
    (hub, jobs.remove(0))
}

/// The port opens while the outcome waits for a place.
#[tokio::test]
async fn a_refused_job_has_its_outcome_though_the_queue_is_full() {
    let (hub, mut jobs) = hub();
    let outbox = hub.outbox.as_ref().unwrap();
    let (message, number) = (Message::default(), None);
    outbox.push(Entry { message, number }).await.unwrap();
    hub.command("scale", br#"{"id": 1, "send": "41"}"#, None, false);

    let (open, opened) = oneshot::channel();
    let refusing = refuse_until(opened, &mut jobs, &hub, "scale");
    let emptying = async {
        open.send(()).unwrap();
        yield_now().await;
        let first = outbox.next().await;
        outbox.done(&first);
        timeout(Duration::from_secs(1), outbox.next()).await
    };
    let (opened, outcome) = join!(refusing, emptying);
    assert_eq!(opened, Some(Ok(())));
    assert_eq!(outcome.unwrap().topic, "line3964r/hall/scale/outcome");
}

#[tokio::test]
async fn nothing_is_refused_after_the_stop() {
    let (hub, mut jobs) = hub();
    hub.stop.cancel();
    let refusing = refuse_until(pending::<()>(), &mut jobs, &hub, "scale");
    assert_eq!(refusing.await, None);
}
