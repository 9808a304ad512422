//! What Home Assistant finds, and what becomes of what it sends; what a line carried, over HTTP.

use alloc::collections::BTreeMap;
use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
};

use rumqttc::v5::mqttbytes::QoS;
use serde_json::{Value, json};
use tokio::task::spawn_blocking;

use super::{
    broker_or_skip,
    listeners::free_ports,
    partner::Partner,
    process::{Gateway, hall, line, metrics, mqtt},
    subscriber::Subscriber,
};

const AREA: &str = "procedure = \"rk512\"
[[line.area]]
name = \"temperatures\"
start = \"DB 10.0\"
length = 2
writable = true
[[line.area.field]]
name = \"setpoint\"
offset = 0
type = \"i16be\"
scale = 0.1
unit = \"°C\"
[[line.area.field]]
name = \"alarm\"
offset = 2
type = \"bit\"
bit = 0
";

fn get(port: u16, path: &str) -> Vec<u8> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: gateway\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    answer
}

#[tokio::test(flavor = "multi_thread")]
async fn a_number_is_written_and_a_button_fetches() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let [port] = free_ports();
    let config = hall(&[
        &mqtt(broker.port),
        "discovery = \"homeassistant\"\n",
        &metrics(port),
        &line("oven", partner.port),
        AREA,
    ]);
    tokio::spawn(partner.serve_rk512());
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let mut found = BTreeMap::new();
    while found.len() < 4 {
        let (topic, payload) = subscriber.next().await;
        if let Some(name) = topic.strip_prefix("homeassistant/") {
            let entity: Value = serde_json::from_slice(&payload).unwrap();
            found.insert(name.replace("/hall/oven_temperatures_", " "), entity);
        }
    }
    let sensor = &found["sensor setpoint/config"];
    assert_eq!(sensor["state_class"], "measurement");
    assert_eq!(found["sensor alarm/config"]["state_class"], Value::Null);
    let number = &found["number setpoint_set/config"];
    let scale = ["min", "max", "step"].map(|key| number[key].clone());
    assert_eq!(scale, [json!(-3276.8), json!(3276.7), json!(0.1)]);

    let command = number["command_template"].as_str().unwrap();
    let command = command.replace("{{ value }}", "21.5");
    let topic = number["command_topic"].as_str().unwrap();
    subscriber.publish(topic, QoS::AtLeastOnce, command).await;
    let outcome = subscriber.outcome("oven").await;
    assert_eq!(outcome["ok"], true, "{outcome}");
    let button = &found["button fetch/config"];
    let topic = button["command_topic"].as_str().unwrap();
    let press = button["payload_press"].as_str().unwrap();
    subscriber.publish(topic, QoS::AtLeastOnce, press).await;
    let area = subscriber
        .json_at(sensor["state_topic"].as_str().unwrap())
        .await;
    assert_eq!(area["fields"]["setpoint"]["value"], 21.5, "{area}");

    let capture = spawn_blocking(move || get(port, "/capture/oven.pcapng")).await;
    let capture = capture.unwrap();
    let (_, file) =
        capture.split_at(capture.windows(4).position(|it| it == b"\r\n\r\n").unwrap() + 4);
    // Section, byte order; and what the line says of itself.
    assert_eq!(file[..4], [0x0A, 0x0D, 0x0D, 0x0A]);
    let text = String::from_utf8_lossy(file);
    assert!(
        text.contains("A STX, attempt 1") && text.contains("the line works"),
        "{text}"
    );
    let none = spawn_blocking(move || get(port, "/capture/none.pcapng")).await;
    assert!(none.unwrap().starts_with(b"HTTP/1.1 404"));
    drop(gateway);
}
