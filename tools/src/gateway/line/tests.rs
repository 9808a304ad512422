use core::{future::pending, time::Duration};

use bytes::Bytes;
use tokio::{join, sync::oneshot, task::yield_now, time::timeout};

use super::refuse_until;
use crate::gateway::{config::Config, hub::Hub};

const CONFIG: &str = r#"
    name = "hall"
    [mqtt]
    broker = "mqtt://h"
    queue = 1
    [[line]]
    name = "scale"
    port = "COM3"
    priority = "low"
"#;

/// The port opens while the outcome waits for a place.
#[tokio::test]
async fn a_refused_job_has_its_outcome_though_the_queue_is_full() {
    let config = Config::parse(CONFIG).unwrap();
    let (hub, mut jobs) = Hub::new(&config);
    let outbox = hub.outbox.as_ref().unwrap();
    outbox.push("t".to_owned(), Bytes::new()).await;
    hub.command("scale", br#"{"id": 1, "send": "41"}"#, false);

    let (open, opened) = oneshot::channel();
    let refusing = refuse_until(opened, &mut jobs[0], &hub, "scale");
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
    let config = Config::parse(CONFIG).unwrap();
    let (hub, mut jobs) = Hub::new(&config);
    hub.stop.cancel();
    let refusing = refuse_until(pending::<()>(), &mut jobs[0], &hub, "scale");
    assert_eq!(refusing.await, None);
}
