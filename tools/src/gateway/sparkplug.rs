//! This gateway as an edge node of Sparkplug B 3.0, and its lines as devices: births and deaths,
//! and what is published in between.
//!
//! The store holds this gateway's own messages; they become metrics when they leave it.

mod device;
mod metric;
mod payload;

use alloc::collections::BTreeMap;
use core::str::FromStr as _;
use std::{fs, path::PathBuf};

use jiff::Timestamp;
use log::warn;
use serde::Deserialize;
use serde_json::Value as Json;
use toml::Spanned;

pub(crate) use self::metric::DataType;
use self::{
    device::Device,
    payload::{Metric, Payload, Value},
};
use super::{
    config::{Config, Sparkplug},
    store::Message,
};

/// First level of all topics.
const NAMESPACE: &str = "spBv1.0";

/// Asks for all births again.
const REBIRTH: &str = "Node Control/Rebirth";

/// Tells which death belongs to which birth.
const BD_SEQ: &str = "bdSeq";

/// An edge node, over all of its connections.
pub(crate) struct Node {
    group: String,
    node: String,
    primary_host: Option<String>,
    /// First levels of this gateway's own topics.
    own_topic: String,
    devices: BTreeMap<String, Device>,
    /// Where the number of the last connection is kept.
    path: PathBuf,
    /// Number of the connection: NBIRTH and NDEATH have it.
    bd_seq: Option<u8>,
    /// Number of the next message.
    seq: u8,
    /// When the births of this connection were published first.
    born_ms: u64,
    host: Host,
}

/// What the primary host said last.
#[derive(Default, Deserialize)]
struct Host {
    online: bool,
    /// In milliseconds since 1970.
    timestamp: i64,
}

/// What is to be published, at most once and not retained.
pub(crate) struct Packet {
    pub(crate) topic: String,
    pub(crate) payload: Vec<u8>,
}

/// What came.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Heard {
    /// The births are wanted once more.
    Rebirth,
    /// Commands for a line, as JSON.
    Commands {
        line: String,
        commands: Vec<String>,
    },
    /// The primary host has come or gone.
    Host,
    Nothing,
}

fn now_ms() -> u64 {
    Timestamp::now().as_millisecond().unsigned_abs()
}

impl Node {
    pub(crate) fn new(config: &Config, settings: &Sparkplug) -> Self {
        let folder = config.store_folder();
        let path = folder.join("bdSeq");
        let before = fs::read_to_string(&path).ok();
        let devices = config.lines.iter().map(Spanned::get_ref);
        let devices = devices.map(|line| (line.name.get_ref().to_string(), Device::new(line)));
        Self {
            group: settings.group.to_string(),
            node: settings.node.as_ref().unwrap_or(&config.name).to_string(),
            primary_host: settings.primary_host.as_ref().map(ToString::to_string),
            own_topic: config.topic(),
            devices: devices.collect(),
            bd_seq: before.and_then(|number| number.trim().parse().ok()),
            path,
            seq: 0,
            born_ms: 0,
            host: Host::default(),
        }
    }

    fn topic(&self, kind: &str) -> String {
        format!("{NAMESPACE}/{}/{kind}/{}", self.group, self.node)
    }

    fn state_topic(&self) -> Option<String> {
        let host = self.primary_host.as_ref()?;
        Some(format!("{NAMESPACE}/STATE/{host}"))
    }

    /// Devices, each of which has a birth and a death.
    pub(crate) fn devices(&self) -> usize {
        self.devices.len()
    }

    /// A connection is about to be made: its will.
    pub(crate) fn will(&mut self) -> Packet {
        let next = self.bd_seq.map_or(0, |before| before.wrapping_add(1));
        self.bd_seq = Some(next);
        let folder = self.path.parent().map_or(Ok(()), fs::create_dir_all);
        if let Err(error) = folder.and_then(|()| fs::write(&self.path, next.to_string())) {
            warn!("{}: {error}", self.path.display());
        }
        (self.host, self.born_ms) = (Host::default(), 0);
        for device in self.devices.values_mut() {
            device.is_born = false;
        }
        self.death()
    }

    /// What the will says too, for a connection that is closed in order.
    pub(crate) fn death(&self) -> Packet {
        let payload = Payload {
            timestamp: Some(now_ms()),
            metrics: vec![self.number_of_connection()],
            seq: None,
        };
        Packet {
            topic: self.topic("NDEATH"),
            payload: payload.to_bytes(),
        }
    }

    fn number_of_connection(&self) -> Metric {
        Metric {
            name: Some(BD_SEQ.to_owned()),
            timestamp: Some(now_ms()),
            datatype: Some(DataType::Int64 as u32),
            value: Some(Value::Long(self.bd_seq.unwrap_or_default().into())),
            ..Metric::default()
        }
    }

    /// All that is subscribed to.
    pub(crate) fn subscriptions(&self) -> Vec<String> {
        let commands = [self.fence(), format!("{}/+", self.topic("DCMD"))];
        commands.into_iter().chain(self.state_topic()).collect()
    }

    /// What is subscribed to once more to hear that the broker has taken all before it.
    pub(crate) fn fence(&self) -> String {
        self.topic("NCMD")
    }

    /// Whether births may be published.
    pub(crate) const fn may_be_born(&self) -> bool {
        self.primary_host.is_none() || self.host.online
    }

    /// The births of the node and of the devices that are up.
    pub(crate) fn births(&mut self) -> Vec<Packet> {
        let now_ms = now_ms();
        if self.born_ms == 0 {
            self.born_ms = now_ms;
        }
        self.seq = 0;
        let rebirth = Metric {
            name: Some(REBIRTH.to_owned()),
            timestamp: Some(now_ms),
            datatype: Some(DataType::Boolean as u32),
            value: Some(Value::Boolean(false)),
            ..Metric::default()
        };
        let metrics = vec![self.number_of_connection(), rebirth];
        let mut packets = vec![self.packet(self.topic("NBIRTH"), metrics)];
        let lines: Vec<_> = self.devices.keys().cloned().collect();
        for line in lines {
            packets.extend(self.birth(&line, |device| device.is_up));
        }
        packets
    }

    /// The birth of a device, if `is_wanted`.
    fn birth(&mut self, line: &str, is_wanted: impl Fn(&Device) -> bool) -> Option<Packet> {
        let topic = format!("{}/{line}", self.topic("DBIRTH"));
        let device = self.devices.get_mut(line)?;
        if !is_wanted(device) {
            device.is_born = false;
            return None;
        }
        device.is_born = true;
        let metrics = device.birth(now_ms());
        Some(self.packet(topic, metrics))
    }

    /// The deaths of devices that were born for what was stored of them, and are not up.
    pub(crate) fn deaths(&mut self) -> Vec<Packet> {
        let dead = self.devices.iter_mut();
        let dead = dead.filter(|(_, device)| device.is_born && !device.is_up);
        let dead = dead.map(|(line, device)| {
            device.is_born = false;
            line.clone()
        });
        let dead: Vec<_> = dead.collect();
        dead.iter().map(|line| self.death_of(line)).collect()
    }

    fn death_of(&mut self, line: &str) -> Packet {
        self.packet(format!("{}/{line}", self.topic("DDEATH")), Vec::new())
    }

    /// With the next number.
    fn packet(&mut self, topic: String, metrics: Vec<Metric>) -> Packet {
        let payload = Payload {
            timestamp: Some(now_ms()),
            metrics,
            seq: Some(self.seq.into()),
        };
        self.seq = self.seq.wrapping_add(1);
        Packet {
            topic,
            payload: payload.to_bytes(),
        }
    }

    /// What a message of this gateway is to hosts: nothing, or packets in their order. What came
    /// before the births is historical.
    ///
    /// # Errors
    /// A message that no metric has a place for.
    pub(crate) fn packets(&mut self, message: &Message) -> Result<Vec<Packet>, String> {
        let rest = message.topic.strip_prefix(&self.own_topic);
        let rest = rest.and_then(|rest| rest.strip_prefix('/'));
        let Some((line, kind)) = rest.and_then(|rest| rest.split_once('/')) else {
            // The gateway's own status is told by its births and deaths.
            return if message.is_retained {
                Ok(Vec::new())
            } else {
                Err("no topic of a device".to_owned())
            };
        };
        let no_device = || format!("there is no device `{line}`");
        let device = self.devices.get_mut(line).ok_or_else(no_device)?;
        let no_metric = || format!("the device has no metric for `{kind}`");
        let news = device.read(kind, &message.payload).ok_or_else(no_metric)?;
        let at_ms = time_of(&message.payload).unwrap_or_else(now_ms);
        let is_historical = at_ms < self.born_ms;
        let before = device.is_up;
        if kind == "status" {
            device.is_up = &message.payload[..] != b"offline";
        }
        let metrics = device.told(news, at_ms, is_historical && !message.is_retained);
        let (is_born, is_up) = (device.is_born, device.is_up);
        if message.is_retained && !is_up {
            // Nothing is told of a device that is down but its death.
            return Ok(if is_born && before {
                self.deaths()
            } else {
                Vec::new()
            });
        }
        let mut packets = Vec::new();
        if !is_born {
            packets.extend(self.birth(line, |_| true));
            if message.is_retained {
                // The birth says it.
                return Ok(packets);
            }
        }
        packets.push(self.packet(format!("{}/{line}", self.topic("DDATA")), metrics));
        Ok(packets)
    }

    /// Takes what came of a subscription.
    ///
    /// # Errors
    /// What is wrong in it.
    pub(crate) fn hear(&mut self, topic: &str, bytes: &[u8]) -> Result<Heard, String> {
        if self.state_topic().as_deref() == Some(topic) {
            return self.hear_host(bytes);
        }
        let device = topic.strip_prefix(&format!("{}/", self.topic("DCMD")));
        if device.is_none() && topic != self.fence() {
            return Ok(Heard::Nothing);
        }
        let payload = Payload::from_bytes(bytes)?;
        let Some(line) = device else {
            let is_rebirth = |metric: &Metric| {
                metric.name.as_deref() == Some(REBIRTH)
                    && metric.value == Some(Value::Boolean(true))
            };
            let is_rebirth = payload.metrics.iter().any(is_rebirth);
            return Ok(if is_rebirth {
                Heard::Rebirth
            } else {
                Heard::Nothing
            });
        };
        let device = self.devices.get(line);
        let device = device.ok_or_else(|| format!("there is no device `{line}`"))?;
        let commands = payload.metrics.iter().map(|metric| {
            let name = metric.name.as_deref().unwrap_or_default();
            device.command(name, metric.value.as_ref())
        });
        Ok(Heard::Commands {
            line: line.to_owned(),
            commands: commands.collect::<Result<_, _>>()?,
        })
    }

    /// `{"online": true, "timestamp": 1}`; what is older than the last does not count.
    fn hear_host(&mut self, bytes: &[u8]) -> Result<Heard, String> {
        let host: Host = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        if host.timestamp < self.host.timestamp || host.online == self.host.online {
            return Ok(Heard::Nothing);
        }
        self.host = host;
        Ok(Heard::Host)
    }
}

/// When what a message tells came about, in milliseconds since 1970.
fn time_of(payload: &[u8]) -> Option<u64> {
    let json: Json = serde_json::from_slice(payload).ok()?;
    let time = Timestamp::from_str(json.get("time")?.as_str()?).ok()?;
    u64::try_from(time.as_millisecond()).ok()
}
