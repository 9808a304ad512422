use bytes::Bytes;
use serde_json::Value;
use tokio::sync::mpsc::Receiver;

use super::*;
use crate::gateway::{job::Action, store::DeadLetters};

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
    hub_of(CONFIG)
}

fn hub_of(config: &str) -> (Arc<Hub>, Receiver<Job>) {
    let config = Config::parse(config).unwrap();
    let mqtt = config.mqtt().unwrap();
    let letters = DeadLetters::new("unused".into(), 0);
    let outbox = Outbox::in_memory(mqtt.queue(), mqtt.overflow, letters).unwrap();
    let (hub, mut jobs) = Hub::new(&config, Some(outbox), Known::nothing());
    (hub, jobs.remove(0))
}

fn send(id: impl Into<Value>) -> Vec<u8> {
    json!({ "id": id.into(), "send": "41" })
        .to_string()
        .into_bytes()
}

fn asked(id: &Value) -> Asked {
    let id = Some(serde_json::from_str(&id.to_string()).unwrap());
    Asked { id, reply: None }
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
        hub.command("scale", &send(id), None, is_duplicate);
    }
    for id in [json!(1), json!("1")] {
        let action = Action::Send(b"A".to_vec());
        let asked = asked(&id);
        assert_eq!(jobs.try_recv(), Ok(Job { asked, action }));
    }
    assert!(jobs.try_recv().is_err());
    assert!(outcomes(&hub).await.is_empty());
}

/// Two programs may use the same `id`, and without one nothing tells commands apart.
#[tokio::test]
async fn what_the_broker_does_not_mark_is_run_and_what_has_no_id_too() {
    let (hub, mut jobs) = hub();
    hub.command("scale", &send(1), None, false);
    hub.command("scale", &send(1), None, false);
    assert!(jobs.try_recv().is_ok() && jobs.try_recv().is_ok());
    let nameless = br#"{"send": "41"}"#;
    hub.command("scale", nameless, None, true);
    hub.command("scale", nameless, None, true);
    assert!(jobs.try_recv().is_ok() && jobs.try_recv().is_ok());
}

#[tokio::test]
async fn the_last_identifiers_are_known() {
    let (hub, mut jobs) = hub();
    let count = u32::try_from(RECENT).unwrap();
    for id in 0..=count {
        hub.command("scale", &send(id), None, false);
        jobs.try_recv().unwrap();
    }
    hub.command("scale", &send(1), None, true);
    assert!(jobs.try_recv().is_err(), "known");
    hub.command("scale", &send(0), None, true);
    assert!(jobs.try_recv().is_ok(), "forgotten");
}

/// One that was refused, because too many waited, has not been run.
#[tokio::test]
async fn a_duplicate_of_a_refused_command_is_run() {
    let (hub, mut jobs) = hub();
    for id in 1..=3 {
        hub.command("scale", &send(id), None, false);
    }
    let told = outcomes(&hub).await;
    assert_eq!(told.len(), 1);
    assert_eq!((&told[0]["id"], &told[0]["ok"]), (&json!(3), &json!(false)));
    assert_eq!(told[0]["error"], "too many commands wait");
    assert!(jobs.try_recv().is_ok());
    hub.command("scale", &send(3), None, true);
    jobs.try_recv().unwrap();
    assert_eq!(jobs.try_recv().unwrap().asked, asked(&json!(3)));

    drop(jobs);
    hub.command("scale", &send(4), None, false);
    assert_eq!(outcomes(&hub).await[0]["error"], "the gateway is stopping");
    let refused = &hub.counts("scale").unwrap().refused;
    assert_eq!(refused.load(Ordering::Relaxed), 2);
}

#[tokio::test]
async fn a_command_for_no_line_has_an_outcome_too() {
    let (hub, mut jobs) = hub();
    hub.command("stove", &send(1), None, false);
    // A topic that no line can have.
    hub.command("a b", &send(2), None, false);
    assert!(jobs.try_recv().is_err());
    let outbox = hub.outbox.as_ref().unwrap();
    let message = outbox.next().await;
    assert_eq!(message.topic, "line3964r/hall/stove/outcome");
    let outcome: Value = serde_json::from_slice(&message.payload).unwrap();
    assert_eq!((&outcome["id"], &outcome["ok"]), (&json!(1), &json!(false)));
    assert_eq!(outcome["error"], "there is no such line");
    assert!(outbox.is_empty());
}

#[tokio::test]
async fn who_asks_for_it_has_an_outcome_of_its_own() {
    let (hub, mut jobs) = hub();
    let reply = Some(Reply {
        topic: "reply/1".to_owned(),
        correlation: Some(Bytes::from_static(b"\x00\x01")),
    });
    hub.command("scale", &send(1), reply, false);
    let job = jobs.try_recv().unwrap();
    hub.outcome("scale", &job.asked, Ok(())).await;
    let outbox = hub.outbox.as_ref().unwrap();
    let (to_all, to_one) = (outbox.next().await, outbox.next().await);
    assert_eq!(to_all.topic, "line3964r/hall/scale/outcome");
    assert_eq!(to_all.correlation, None);
    assert_eq!(to_one.topic, "reply/1");
    assert_eq!(to_one.correlation.unwrap(), b"\x00\x01"[..]);
    assert_eq!(to_one.payload, to_all.payload);
}

#[tokio::test]
async fn a_read_only_line_sends_and_writes_nothing() {
    let config = CONFIG.replace("commands = 2", "read_only = true\nprocedure = \"rk512\"");
    let (hub, mut jobs) = hub_of(&config);
    for command in [
        r#"{"send": "41"}"#,
        r#"{"write": "a", "hex": "00 00"}"#,
        r#"{"fetch": "a"}"#,
    ] {
        hub.command("scale", command.as_bytes(), None, false);
    }
    let fetch = Action::Fetch {
        area: "a".to_owned(),
    };
    assert_eq!(jobs.try_recv().unwrap().action, fetch);
    assert!(jobs.try_recv().is_err());
    let told = outcomes(&hub).await;
    assert_eq!(told.len(), 2);
    assert!(
        told.iter()
            .all(|outcome| outcome["error"] == "the line is read-only")
    );
}

#[tokio::test(start_paused = true)]
async fn a_silent_line_is_told() {
    let (hub, _jobs) = hub();
    let after = Duration::from_secs(10);
    let status = || hub.lines["scale"].is_online();
    let mut watching = core::pin::pin!(hub.watch_for_silence("scale", after));
    let mut wait = async |seconds| {
        tokio::select! {
            () = &mut watching => {}
            () = sleep(Duration::from_secs(seconds)) => {}
        }
    };
    hub.online("scale", true);
    wait(9).await;
    assert!(status());
    wait(2).await;
    assert!(!status());
    hub.online("scale", true);
    assert!(status());
    wait(9).await;
    hub.online("scale", false);
    wait(20).await;
    hub.online("scale", true);
    wait(9).await;
    assert!(status());
    let outbox = hub.outbox.as_ref().unwrap();
    assert_eq!(outbox.next().await.payload, b"online"[..]);
    wait(3).await;
    assert_eq!(outbox.next().await.payload, b"silent"[..]);
}
