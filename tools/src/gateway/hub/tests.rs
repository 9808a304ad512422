use serde_json::Value;
use tokio::sync::mpsc::Receiver;

use super::*;
use crate::gateway::job::Action;

const CONFIG: &str = r#"
    name = "hall"
    [mqtt]
    broker = "mqtt://h"
    [[line]]
    name = "scale"
    port = "COM3"
    priority = "low"
    commands = 2
"#;

/// A gateway with one line, and the jobs that reach it.
fn hub() -> (Arc<Hub>, Receiver<Job>) {
    let (hub, mut jobs) = Hub::new(&Config::parse(CONFIG).unwrap());
    (hub, jobs.remove(0))
}

fn send(id: impl Into<Value>) -> Vec<u8> {
    json!({ "id": id.into(), "send": "41" })
        .to_string()
        .into_bytes()
}

/// The outcomes that wait for the broker.
async fn outcomes(hub: &Hub) -> Vec<Value> {
    let outbox = hub.outbox.as_ref().unwrap();
    let mut outcomes = Vec::new();
    while !outbox.is_empty() {
        let message = outbox.next().await;
        assert_eq!(message.topic, "line3964r/hall/scale/outcome");
        outcomes.push(serde_json::from_slice(&message.payload).unwrap());
    }
    outcomes
}

#[tokio::test]
async fn a_duplicate_of_a_known_command_is_not_run_again() {
    let (hub, mut jobs) = hub();
    for (is_duplicate, id) in [
        (false, json!(1)),
        // As the broker hands it over again after a lost connection.
        (true, json!(1)),
        // Lost on the way the first time.
        (true, json!("1")),
    ] {
        hub.command("scale", &send(id), is_duplicate);
    }
    for id in [json!(1), json!("1")] {
        let action = Action::Send(b"A".to_vec());
        let id = Some(id);
        assert_eq!(jobs.try_recv(), Ok(Job { id, action }));
    }
    assert!(jobs.try_recv().is_err());
    assert!(outcomes(&hub).await.is_empty());
}

/// Two programs may use the same `id`, and without one nothing tells commands apart.
#[tokio::test]
async fn what_the_broker_does_not_mark_is_run_and_what_has_no_id_too() {
    let (hub, mut jobs) = hub();
    hub.command("scale", &send(1), false);
    hub.command("scale", &send(1), false);
    assert!(jobs.try_recv().is_ok() && jobs.try_recv().is_ok());
    let nameless = br#"{"send": "41"}"#;
    hub.command("scale", nameless, true);
    hub.command("scale", nameless, true);
    assert!(jobs.try_recv().is_ok() && jobs.try_recv().is_ok());
}

#[tokio::test]
async fn the_last_identifiers_are_known() {
    let (hub, mut jobs) = hub();
    let count = u32::try_from(RECENT).unwrap();
    for id in 0..=count {
        hub.command("scale", &send(id), false);
        jobs.try_recv().unwrap();
    }
    hub.command("scale", &send(1), true);
    assert!(jobs.try_recv().is_err(), "known");
    hub.command("scale", &send(0), true);
    assert!(jobs.try_recv().is_ok(), "forgotten");
}

/// One that was refused, because too many waited, has not been run.
#[tokio::test]
async fn a_duplicate_of_a_refused_command_is_run() {
    let (hub, mut jobs) = hub();
    for id in 1..=3 {
        hub.command("scale", &send(id), false);
    }
    let told = outcomes(&hub).await;
    assert_eq!(told.len(), 1);
    assert_eq!((&told[0]["id"], &told[0]["ok"]), (&json!(3), &json!(false)));
    assert_eq!(told[0]["error"], "too many commands wait");
    assert!(jobs.try_recv().is_ok());
    hub.command("scale", &send(3), true);
    jobs.try_recv().unwrap();
    assert_eq!(jobs.try_recv().unwrap().id, Some(json!(3)));

    drop(jobs);
    hub.command("scale", &send(4), false);
    assert_eq!(outcomes(&hub).await[0]["error"], "the gateway is stopping");
    let refused = &hub.counts("scale").unwrap().refused;
    assert_eq!(refused.load(Ordering::Relaxed), 2);
}

#[tokio::test]
async fn a_command_for_no_line_goes_nowhere() {
    let (hub, mut jobs) = hub();
    hub.command("stove", &send(1), false);
    assert!(jobs.try_recv().is_err());
    assert!(outcomes(&hub).await.is_empty());
}
