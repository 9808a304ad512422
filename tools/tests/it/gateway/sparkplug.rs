//! The gateway as an edge node of Sparkplug B, as a host sees it that was written by the
//! specification: `sparkplug.py`.

use alloc::collections::BTreeMap;
use core::time::Duration;
use std::{
    io::Write as _,
    process::{Command, Stdio},
};

use proto3964r::tokio::SendError;
use rk512::tokio::Client as Plc;
use rumqttc::v5::mqttbytes::QoS;
use serde_json::Value;
use tempfile::TempDir;
use tokio::time::{sleep, timeout};

use super::{
    broker_or_skip,
    partner::{PARTNER, Partner},
    process::{Gateway, PATIENCE, hall, line, mqtt},
    subscriber::Subscriber,
};

const READER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/gateway/sparkplug.py");

const NODE: &str = "[mqtt.sparkplug]\ngroup = \"plant\"\n";

/// In the table of `NODE`.
const HOST: &str = "primary_host = \"scada\"\n";

const WEIGHT: &str = "[[line.telegram]]
name = \"weight\"
starts_with = \"57\"
length = 6
field = [
  { name = \"gross\", offset = 1, type = \"i16be\", scale = 0.1, unit = \"kg\" },
  { name = \"raw\", offset = 1, type = \"i16be\" },
  { name = \"count\", offset = 3, type = \"u16be\" },
  { name = \"stable\", offset = 5, type = \"bit\", bit = 0 },
]
";

const AREA: &str = "procedure = \"rk512\"
[[line.area]]
name = \"setpoints\"
start = \"DB 20.0\"
length = 3
served = true
writable = true
field = [{ name = \"speed\", offset = 0, type = \"i16be\" }, { name = \"heat\", offset = 2, type = \"f32be\" }]
";

/// All that a host hears, in its order.
struct Host {
    subscriber: Subscriber,
    heard: Vec<(String, Vec<u8>)>,
}

impl Host {
    async fn new(port: u16) -> Self {
        Self {
            subscriber: Subscriber::new(port).await,
            heard: Vec::new(),
        }
    }

    /// Hears until `kind` has come `count` times from now on.
    async fn hears(&mut self, kind: &str, count: usize) {
        let mut left = count;
        while left > 0 {
            let message = self.subscriber.next().await;
            assert!(!message.0.starts_with("line3964r/"), "{}", message.0);
            let levels = format!("{}/", message.0);
            left -= usize::from(levels.contains(&format!("/{kind}/")));
            self.keep(message);
        }
    }

    /// Hears until it is quiet.
    async fn hears_all(&mut self) {
        while let Some(message) = self.subscriber.next_within(Duration::from_secs(2)).await {
            self.keep(message);
        }
    }

    /// Says that the primary host `scada` is online, until births come.
    async fn is_online(&mut self, at_ms: u32) {
        let state = format!("{{\"online\": true, \"timestamp\": {at_ms}}}");
        let mut is_born = false;
        while !is_born {
            self.says(&state).await;
            let pause = Duration::from_millis(300);
            while let Some(message) = self.subscriber.next_within(pause).await {
                is_born |= message.0.contains("/NBIRTH/");
                self.keep(message);
            }
        }
    }

    async fn says(&self, state: &str) {
        self.subscriber
            .publish("spBv1.0/STATE/scada", QoS::AtLeastOnce, state)
            .await;
    }

    fn keep(&mut self, message: (String, Vec<u8>)) {
        // Its own commands and the state of a host are none of a node's.
        if !["/NCMD/", "/DCMD/", "/STATE/"]
            .iter()
            .any(|own| message.0.contains(own))
        {
            self.heard.push(message);
        }
    }

    /// What all of it says, once it has kept every rule.
    fn read(&self) -> Vec<Value> {
        let mut python = Command::new("python3")
            .arg(READER)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = String::new();
        for (topic, payload) in &self.heard {
            let hex: String = payload.iter().map(|byte| format!("{byte:02X}")).collect();
            lines += &format!("{topic} {hex}\n");
        }
        let mut input = python.stdin.take().unwrap();
        let writing = std::thread::spawn(move || input.write_all(lines.as_bytes()));
        let output = python.wait_with_output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        writing.join().unwrap().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        text.lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect()
    }

    /// A command with one metric, as a host writes it: name, type, and the field of its value.
    async fn commands(&self, topic: &str, name: &str, data_type: u8, value: &[u8]) {
        let mut metric = vec![0x0A, u8::try_from(name.len()).unwrap()];
        metric.extend(name.as_bytes());
        metric.extend([0x18, 1, 0x20, data_type]);
        metric.extend(value);
        let mut payload = vec![0x08, 1, 0x12, u8::try_from(metric.len()).unwrap()];
        payload.extend(metric);
        self.subscriber
            .publish(topic, QoS::AtMostOnce, payload)
            .await;
    }
}

/// Of the messages of a kind about a device, the value of a metric where they have it.
fn values<'m>(messages: &'m [Value], kind: &str, device: &str, name: &str) -> Vec<&'m Value> {
    let of_device = messages
        .iter()
        .filter(|message| message["kind"] == kind && message["device"] == device);
    let metrics = of_device.flat_map(|message| message["metrics"].as_array().unwrap());
    metrics.filter(|metric| metric["name"] == name).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn births_data_commands_and_deaths() {
    for protocol in ["5", "3.1.1"] {
        let broker = broker_or_skip!();
        let (scale, plc) = (Partner::new().await, Partner::new().await);
        let folder = TempDir::new().unwrap();
        let store = format!("[store]\npath = \"{}\"\n", folder.path().display());
        let protocol = format!("protocol = \"{protocol}\"\n");
        let lines = [line("scale", scale.port), line("plc", plc.port)];
        let config = hall(&[
            &mqtt(broker.port),
            &protocol,
            NODE,
            &store,
            &lines[0],
            WEIGHT,
            &lines[1],
            AREA,
        ]);
        let mut host = Host::new(broker.port).await;
        let gateway = Gateway::start(&config);
        let scale = scale.link().await;
        let plc = Plc::new(plc.stream().await, PARTNER, rk512::Config::DEFAULT);
        host.hears("DBIRTH", 2).await;
        scale.send(&[0x57, 0xFF, 0xFB, 1, 0, 1]).await.unwrap();
        host.hears("DDATA/hall/scale", 1).await;
        scale.send(b"other").await.unwrap();

        let device = "spBv1.0/plant/DCMD/hall/plc";
        // -2 of 16 bits, in 32 of the wire.
        let minus_2 = [0x50, 0xFE, 0xFF, 0xFF, 0xFF, 0x0F];
        host.commands(device, "area/setpoints/speed", 3, &minus_2)
            .await;
        let mut half = vec![0x65];
        half.extend(0.5_f32.to_le_bytes());
        host.commands(device, "area/setpoints/heat", 9, &half).await;
        let area = rk512::Area::db(20, 0);
        let written = async {
            while plc.fetch(area, 3).await.unwrap() != [0xFF, 0xFE, 0x3F, 0, 0, 0] {
                sleep(Duration::from_millis(20)).await;
            }
        };
        timeout(PATIENCE, written).await.unwrap();
        let mut command = vec![0x7A, 14];
        command.extend(br#"{"send": "41"}"#);
        let device = "spBv1.0/plant/DCMD/hall/scale";
        host.commands(device, "command", 12, &command).await;
        assert_eq!(scale.receive().await.unwrap(), b"A");
        host.commands(device, "status", 12, &command).await;
        gateway.logs("`status` takes no commands");

        host.hears_all().await;
        let rebirth = "Node Control/Rebirth";
        host.commands("spBv1.0/plant/NCMD/hall", rebirth, 11, &[0x70, 1])
            .await;
        host.hears("DBIRTH", 2).await;
        // Over 255 and back to 0.
        for number in 0..300_u16 {
            let [high, low] = number.to_be_bytes();
            scale.send(&[0x57, 0, 1, high, low, 0]).await.unwrap();
        }
        drop(scale);
        host.hears("DDEATH/hall/scale", 1).await;
        gateway.ends();
        host.hears("NDEATH", 1).await;

        let heard = host.read();
        let first = |name| values(&heard, "DDATA", "scale", name)[0];
        let of_type = |metric: &Value, data_type: u8| {
            assert_eq!(metric["datatype"], data_type, "{metric}");
            assert_eq!(metric["is_historical"], Value::Null, "{metric}");
            metric["value"].clone()
        };
        assert_eq!(of_type(first("telegram/weight"), 17), "57 FF FB 01 00 01");
        assert_eq!(of_type(first("telegram/weight/gross"), 10), -0.5);
        assert_eq!(of_type(first("telegram/weight/raw"), 3), -5);
        assert_eq!(of_type(first("telegram/weight/count"), 6), 256);
        assert_eq!(of_type(first("telegram/weight/stable"), 11), true);
        assert_eq!(of_type(first("telegram"), 17), "6F 74 68 65 72");
        let speeds = values(&heard, "DDATA", "plc", "area/setpoints/speed");
        assert_eq!(of_type(speeds.last().unwrap(), 3), -2);
        let heats = values(&heard, "DDATA", "plc", "area/setpoints/heat");
        assert_eq!(of_type(heats.last().unwrap(), 9), 0.5);
        // The birth after it was asked for says what came before.
        let births = values(&heard, "DBIRTH", "scale", "telegram/weight/raw");
        // The last is that of a line that was opened once more.
        assert!((2..=3).contains(&births.len()), "{births:?}");
        assert_eq!(births[0]["is_null"], true);
        assert_eq!(births[1]["value"], -5);
        let counts = values(&heard, "DDATA", "scale", "telegram/weight/count");
        let counts = counts.iter().skip(1).map(|count| count["value"].as_u64());
        assert!(counts.eq((0..300).map(Some)), "in order, none lost");
    }
}

/// What was acknowledged while the broker was away comes, marked; a gateway that is killed is dead
/// by its will, and the next one has the next number.
#[tokio::test(flavor = "multi_thread")]
async fn what_was_stored_is_historical_and_nothing_is_lost() {
    let mut broker = broker_or_skip!();
    let partner = Partner::new().await;
    let folder = TempDir::new().unwrap();
    let store = format!("[store]\npath = \"{}\"\n", folder.path().display());
    let line = line("scale", partner.port);
    let config = hall(&[&mqtt(broker.port), NODE, HOST, &store, &line, WEIGHT]);
    let mut host = Host::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    host.is_online(1).await;
    let mut number = 0_u16;
    let mut telegram = || {
        let [high, low] = number.to_be_bytes();
        number += 1;
        [0x57, 0, 1, high, low, 0]
    };
    for _ in 0..20 {
        scale.send(&telegram()).await.unwrap();
    }
    host.hears_all().await;
    broker.stop();
    gateway.logs("next attempt in");
    for _ in 0..30 {
        scale.send(&telegram()).await.unwrap();
    }
    broker.start_again();
    // Not before the host is connected again: what is sent at QoS 0 no broker keeps for it.
    host.is_online(2).await;
    for _ in 0..10 {
        scale.send(&telegram()).await.unwrap();
    }
    drop(gateway); // SIGKILL
    host.hears("NDEATH", 1).await;
    drop(scale);
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    host.is_online(3).await;
    loop {
        match scale.send(&telegram()).await {
            Ok(()) => break,
            Err(SendError::Failed(_)) => {}
            Err(error) => panic!("{error}"),
        }
    }
    host.hears_all().await;
    gateway.ends();
    host.hears("NDEATH", 1).await;

    let heard = host.read();
    let counts = values(&heard, "DDATA", "scale", "telegram/weight/count");
    let first = |number: u64| counts.iter().find(|count| count["value"] == number);
    for number in 0..61 {
        let count = first(number).unwrap_or_else(|| panic!("{number} is lost: {counts:?}"));
        // Those about the kill may or may not have been taken before it.
        if number < 50 || number == 60 {
            let is_historical = count["is_historical"] == true;
            assert_eq!(is_historical, (20..50).contains(&number), "{count}");
        }
    }
    // What came twice has the number that it had.
    let mut by_seq = BTreeMap::new();
    for (count, seq) in counts.iter().zip(values(&heard, "DDATA", "scale", "seq")) {
        let known = by_seq.insert(seq["value"].as_u64(), &count["value"]);
        assert!(
            known.is_none_or(|known| *known == count["value"]),
            "{count}"
        );
    }
    let births = heard.iter().filter(|message| message["kind"] == "NBIRTH");
    let births = births.map(|birth| birth["metrics"][0]["value"].as_u64());
    assert_eq!(
        births.clone().next(),
        Some(Some(0)),
        "{:?}",
        births.collect::<Vec<_>>()
    );
}

/// Births wait for the primary host, and all waits while it is gone.
#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_published_without_the_primary_host() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let line = line("scale", partner.port);
    let config = hall(&[&mqtt(broker.port), NODE, HOST, &line, WEIGHT]);
    let mut host = Host::new(broker.port).await;
    let gateway = Gateway::start(&config);
    let scale = partner.link().await;
    gateway.logs("the primary host is not online, messages wait");
    scale.send(&[0x57, 0, 1, 0, 0, 0]).await.unwrap();
    assert_eq!(
        host.subscriber.next_within(Duration::from_secs(1)).await,
        None
    );
    host.is_online(1000).await;
    // An older word does not count, a newer one does.
    host.says(r#"{"online": false, "timestamp": 999}"#).await;
    scale.send(&[0x57, 0, 1, 0, 1, 0]).await.unwrap();
    host.hears("DDATA", 1).await;
    host.says(r#"{"online": false, "timestamp": 1001}"#).await;
    host.hears("NDEATH", 1).await;
    gateway.logs("the primary host is gone, messages wait");
    scale.send(&[0x57, 0, 1, 0, 2, 0]).await.unwrap();
    host.is_online(1002).await;
    host.hears_all().await;
    gateway.ends();
    host.hears("NDEATH", 1).await;
    let heard = host.read();
    let counts = values(&heard, "DDATA", "scale", "telegram/weight/count");
    let counts: Vec<_> = counts.iter().map(|count| count["value"].as_u64()).collect();
    assert_eq!(counts, [Some(0), Some(1), Some(2)]);
}
