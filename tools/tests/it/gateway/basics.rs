//! One line, and what its users see.

use rumqttc::v5::mqttbytes::QoS;
use serde_json::{Value, json};
use tokio::{
    io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader},
    net::TcpStream,
    task::spawn_blocking,
};

use super::{
    broker_or_skip,
    listeners::free_ports,
    partner::Partner,
    process::{Gateway, hall, line, metric, metrics, mqtt},
    subscriber::Subscriber,
};

const SCALE: &str = "
[[line.telegram]]
name = \"weight\"
starts_with = \"57\"
length = 6
[[line.telegram.field]]
name = \"gross\"
offset = 1
type = \"i16be\"
scale = 0.1
unit = \"kg\"
[[line.telegram.field]]
name = \"unit\"
offset = 3
type = \"text\"
length = 3
";

#[tokio::test(flavor = "multi_thread")]
async fn telegrams_commands_and_the_end() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let [port] = free_ports();
    let config = hall(&[
        &mqtt(broker.port),
        "discovery = \"homeassistant\"\n",
        &metrics(port),
        &line("scale", partner.port),
        SCALE,
    ]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;

    let topic = "homeassistant/sensor/hall/scale_weight_gross/config";
    let sensor = subscriber.json_at(topic).await;
    assert_eq!(
        sensor["state_topic"],
        "line3964r/hall/scale/telegram/weight"
    );
    assert_eq!(
        sensor["value_template"],
        "{{ value_json.fields['gross'].value }}"
    );
    assert_eq!(sensor["unit_of_measurement"], "kg");
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"online"
    );

    scale.send(b"W\x00\x7Bkg ").await.unwrap();
    let weight = subscriber
        .json_at("line3964r/hall/scale/telegram/weight")
        .await;
    assert_eq!(weight["hex"], "57 00 7B 6B 67 20");
    assert_eq!(
        weight["fields"],
        json!({ "gross": { "value": 12.3, "unit": "kg" }, "unit": { "value": "kg" } })
    );
    assert_eq!(
        (&weight["seq"], &weight["possible_repeat"]),
        (&json!(1), &Value::Null)
    );
    // What a scale sends that has missed the acknowledgement.
    scale.send(b"W\x00\x7Bkg ").await.unwrap();
    let again = subscriber
        .json_at("line3964r/hall/scale/telegram/weight")
        .await;
    assert_eq!(
        (&again["seq"], &again["possible_repeat"]),
        (&json!(2), &json!(true))
    );
    scale.send(b"?").await.unwrap();
    let other = subscriber.json_at("line3964r/hall/scale/telegram").await;
    assert_eq!(
        (&other["hex"], &other["fields"]),
        (&json!("3F"), &Value::Null)
    );

    let command = r#"{"id": 7, "send_text": "TARE"}"#;
    subscriber.command("scale", command).await;
    assert_eq!(scale.receive().await.unwrap(), b"TARE");
    let outcome = subscriber.outcome("scale").await;
    assert_eq!((&outcome["id"], &outcome["ok"]), (&json!(7), &json!(true)));
    subscriber.command("scale", "TARE").await;
    let outcome = subscriber.outcome("scale").await;
    assert_eq!(outcome["ok"], json!(false));
    assert!(
        outcome["error"]
            .as_str()
            .unwrap()
            .starts_with("no command: ")
    );

    for (name, value) in [
        ("line3964r_line_received_total{line=\"scale\"}", 3),
        ("line3964r_line_possible_repeats_total{line=\"scale\"}", 1),
        ("line3964r_line_commands_refused_total{line=\"scale\"}", 1),
        ("line3964r_mqtt_dropped_total", 0),
    ] {
        let read = spawn_blocking(move || metric(port, name)).await;
        assert_eq!(read.unwrap(), value, "{name}");
    }

    gateway.ends();
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"offline"
    );
    assert_eq!(subscriber.at("line3964r/hall/status").await, b"offline");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_lost_port_is_opened_again_and_a_killed_gateway_is_told_offline() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = hall(&[&mqtt(broker.port), &line("scale", partner.port)]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"online"
    );
    drop(scale);
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"offline"
    );
    let command = r#"{"send": "41"}"#;
    let scale = partner.link().await;
    assert_eq!(
        subscriber.at("line3964r/hall/scale/status").await,
        b"online"
    );
    subscriber
        .publish("line3964r/hall/scale/command", QoS::AtMostOnce, command)
        .await;
    assert_eq!(scale.receive().await.unwrap(), b"A");
    drop(gateway); // killed
    assert_eq!(subscriber.at("line3964r/hall/status").await, b"offline");
}

#[tokio::test(flavor = "multi_thread")]
async fn areas_polled_fetched_and_written() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = format!(
        "name = \"hall\"\n{}{}procedure = \"rk512\"
[[line.area]]
name = \"oven\"
start = \"DB 10.0\"
length = 4
poll_s = 0.1
writable = true
field = [
  {{ name = \"setpoint\", offset = 0, type = \"u16be\" }},
  {{ name = \"actual\", offset = 4, type = \"f32be\", unit = \"°C\" }},
]
[[line.area]]
name = \"missing\"
start = \"DB 11.0\"
length = 1
",
        mqtt(broker.port),
        line("plc", partner.port),
    );
    tokio::spawn(partner.serve_rk512());
    let mut subscriber = Subscriber::new(broker.port).await;
    let _gateway = Gateway::start(&config);
    let oven = "line3964r/hall/plc/area/oven";
    let first = subscriber.json_at(oven).await;
    assert_eq!(first["hex"], "00 07 00 00 00 00 00 00");
    assert_eq!(first["fields"]["setpoint"], json!({ "value": 7 }));
    let write = r#"{"id": "w", "write": "oven", "fields": {"setpoint": 300, "actual": 21.5}}"#;
    subscriber.command("plc", write).await;
    let outcome = subscriber.outcome("plc").await;
    assert_eq!(
        (&outcome["id"], &outcome["ok"]),
        (&json!("w"), &json!(true)),
        "{outcome}"
    );
    let then = subscriber.json_at(oven).await;
    assert_eq!(then["hex"], "01 2C 00 00 41 AC 00 00");
    assert_eq!(
        then["fields"]["actual"],
        json!({ "value": 21.5, "unit": "°C" })
    );
    for (command, error) in [
        (r#"{"fetch": "missing"}"#, ""),
        (r#"{"fetch": "stove"}"#, "no area `stove` on this line"),
        (
            r#"{"write": "missing", "hex": "00 00"}"#,
            "`missing` is not writable",
        ),
        (
            r#"{"write": "oven", "fields": {"setpoint": 65536}}"#,
            "`setpoint`: 65536 does not fit",
        ),
        (
            r#"{"send": "41"}"#,
            "send is for lines of 3964r; this one has fetch and write",
        ),
    ] {
        subscriber.command("plc", command).await;
        let outcome = subscriber.outcome("plc").await;
        assert_eq!(outcome["ok"], json!(false), "{command}");
        assert!(
            outcome["error"].as_str().unwrap().contains(error),
            "{outcome}"
        );
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn events_and_commands_over_tcp_without_a_broker() {
    let partner = Partner::new().await;
    let [port] = free_ports();
    let tcp = format!("[tcp]\nlisten = \"127.0.0.1:{port}\"\n");
    let config = hall(&[&tcp, &line("scale", partner.port)]);
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    gateway.logs("1 lines");
    let (reader, mut writer) = TcpStream::connect(("127.0.0.1", port))
        .await
        .unwrap()
        .into_split();
    let mut events = BufReader::new(reader).lines();
    let command = b"{\"line\": \"scale\", \"command\": {\"id\": 1, \"send\": \"41 42\"}}\n";
    writer.write_all(command).await.unwrap();
    assert_eq!(scale.receive().await.unwrap(), b"AB");
    let mut next = async || -> Value {
        serde_json::from_str(&events.next_line().await.unwrap().unwrap()).unwrap()
    };
    let outcome = next().await;
    assert_eq!(
        (&outcome["event"], &outcome["ok"]),
        (&json!("outcome"), &json!(true))
    );
    scale.send(b"12").await.unwrap();
    let telegram = next().await;
    assert_eq!(
        (&telegram["line"], &telegram["hex"]),
        (&json!("scale"), &json!("31 32"))
    );
    gateway.ends();
}
