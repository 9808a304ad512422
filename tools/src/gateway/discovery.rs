//! What Home Assistant finds by itself: one sensor for each field.

use alloc::collections::BTreeSet;

use serde_json::{Map, Value, json};
use toml::Spanned;

use super::{
    config::{Config, Name, Prefix},
    field::Field,
    hub::Hub,
    outbox::Outbox,
};

/// Retains the description of every field of the hub's lines, under
/// `PREFIX/sensor/GATEWAY/LINE_KIND_FIELD/config`; returns the topics.
pub(crate) fn announce(config: &Config, hub: &Hub) -> BTreeSet<String> {
    let mut topics = BTreeSet::new();
    let prefix = config.mqtt().and_then(|mqtt| mqtt.discovery.as_ref());
    let (Some(prefix), Some(outbox)) = (prefix, &hub.outbox) else {
        return topics;
    };
    let mut announce = |line, event: &str, kind, fields: &[Spanned<Field>]| {
        let state_topic = format!("{}/{line}/{event}/{kind}", hub.topic);
        for field in fields.iter().map(Spanned::get_ref) {
            let sensor = Sensor {
                config,
                hub,
                line,
                kind,
                field,
            };
            topics.insert(sensor.announce(prefix, &state_topic, outbox));
        }
    };
    for line in config.lines.iter().map(Spanned::get_ref) {
        let name = line.name.get_ref();
        if !hub.lines.contains_key(name.as_str()) {
            continue;
        }
        for kind in line.telegrams.iter().map(Spanned::get_ref) {
            announce(name, "telegram", &kind.name, &kind.fields);
        }
        for area in line.areas.iter().map(Spanned::get_ref) {
            announce(name, "area", &area.name, &area.fields);
        }
    }
    topics
}

/// A field of one kind of telegram or of an area.
struct Sensor<'s> {
    config: &'s Config,
    hub: &'s Hub,
    line: &'s Name,
    kind: &'s Name,
    field: &'s Field,
}

impl Sensor<'_> {
    /// Returns the topic.
    fn announce(&self, prefix: &Prefix, state_topic: &str, outbox: &Outbox) -> String {
        let Self {
            config,
            hub,
            line,
            kind,
            field,
        } = self;
        let (gateway, name) = (&config.name, &field.name);
        let id = format!("{line}_{kind}_{name}");
        let value = format!("{{{{ value_json.fields['{name}'].value }}}}");
        let mut sensor = Map::new();
        let mut set = |key: &str, value: Value| sensor.insert(key.to_owned(), value);
        set("name", json!(format!("{kind} {name}")));
        set("unique_id", json!(format!("{gateway}_{id}")));
        set("state_topic", json!(state_topic));
        set("value_template", json!(value));
        set("availability_mode", json!("all"));
        set(
            "availability",
            json!([
                { "topic": config.status_topic() },
                {
                    "topic": format!("{}/{line}/status", hub.topic),
                    "value_template": "{{ 'online' if value == 'online' else 'offline' }}",
                },
            ]),
        );
        set(
            "device",
            json!({
                "identifiers": [format!("{gateway}_{line}")],
                "name": format!("{gateway} {line}"),
            }),
        );
        if let Some(unit) = &field.unit {
            set("unit_of_measurement", json!(unit));
        }
        if let Some(class) = &field.device_class {
            set("device_class", json!(class));
        }
        let topic = format!("{}/sensor/{gateway}/{id}/config", prefix.0);
        outbox.retain(topic.clone(), Value::Object(sensor).to_string().into());
        topic
    }
}
