//! What Home Assistant finds by itself: one sensor for each field.

use serde_json::{Map, Value, json};
use toml::Spanned;

use super::{
    config::{Config, Name, Prefix},
    field::Field,
    hub::Hub,
    outbox::Outbox,
};

/// Retains the description of every field, under `PREFIX/sensor/GATEWAY/LINE_KIND_FIELD/config`.
pub(crate) fn announce(config: &Config, prefix: &Prefix, hub: &Hub, outbox: &Outbox) {
    for line in config.lines.iter().map(Spanned::get_ref) {
        let name = line.name.get_ref();
        for kind in line.telegrams.iter().map(Spanned::get_ref) {
            let topic = format!("{}/{name}/telegram/{}", hub.topic, kind.name);
            for field in kind.fields.iter().map(Spanned::get_ref) {
                let sensor = Sensor {
                    config,
                    hub,
                    line: name,
                    kind: &kind.name,
                    field,
                };
                sensor.announce(prefix, &topic, outbox);
            }
        }
        for area in line.areas.iter().map(Spanned::get_ref) {
            let topic = format!("{}/{name}/area/{}", hub.topic, area.name);
            for field in area.fields.iter().map(Spanned::get_ref) {
                let sensor = Sensor {
                    config,
                    hub,
                    line: name,
                    kind: &area.name,
                    field,
                };
                sensor.announce(prefix, &topic, outbox);
            }
        }
    }
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
    fn announce(&self, prefix: &Prefix, state_topic: &str, outbox: &Outbox) {
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
        outbox.retain(topic, Value::Object(sensor).to_string().into());
    }
}
