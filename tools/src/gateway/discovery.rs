//! What Home Assistant finds by itself: a sensor for each field, a number for each that may be
//! written, a button to fetch each area.

use alloc::collections::BTreeSet;

use serde_json::{Map, Value, json};
use toml::Spanned;

use super::{
    config::{Config, Name},
    field::Field,
    hub::Hub,
};

/// Retains the description of all that the hub's lines have, under
/// `PREFIX/KIND/GATEWAY/ID/config`; returns the topics.
pub(crate) fn announce(config: &Config, hub: &Hub) -> BTreeSet<String> {
    let prefix = config.mqtt().and_then(|mqtt| mqtt.discovery.as_ref());
    let (Some(prefix), Some(outbox)) = (prefix, &hub.outbox) else {
        return BTreeSet::new();
    };
    let mut entities = Vec::new();
    for line in config.lines.iter().map(Spanned::get_ref) {
        let name = line.name.get_ref();
        if !hub.lines.contains_key(name.as_str()) {
            continue;
        }
        let device = Device {
            config,
            hub,
            line: name,
        };
        for kind in line.telegrams.iter().map(Spanned::get_ref) {
            let sensors = kind.fields.iter().map(Spanned::get_ref);
            entities.extend(sensors.map(|field| device.sensor("telegram", &kind.name, field)));
        }
        for area in line.areas.iter().map(Spanned::get_ref) {
            for field in area.fields.iter().map(Spanned::get_ref) {
                entities.push(device.sensor("area", &area.name, field));
                if area.writable && !line.read_only {
                    entities.extend(device.number(&area.name, field));
                }
            }
            entities.push(device.fetch_button(&area.name));
        }
    }
    let mut topics = BTreeSet::new();
    for (kind, id, entity) in entities {
        let topic = format!("{}/{kind}/{}/{id}/config", prefix.0, config.name);
        outbox.retain(topic.clone(), Value::Object(entity).to_string().into());
        topics.insert(topic);
    }
    topics
}

/// Its kind, what identifies it within the gateway, and its description.
type Entity = (&'static str, String, Map<String, Value>);

/// A line, as Home Assistant sees it.
struct Device<'d> {
    config: &'d Config,
    hub: &'d Hub,
    line: &'d Name,
}

impl Device<'_> {
    /// What is said of every entity.
    fn entity(&self, kind: &'static str, id: String, name: &str) -> Entity {
        let Self { config, hub, line } = self;
        let gateway = &config.name;
        let described = [
            ("name", json!(name)),
            ("unique_id", json!(format!("{gateway}_{id}"))),
            ("availability_mode", json!("all")),
            (
                "availability",
                json!([
                    { "topic": config.status_topic() },
                    {
                        "topic": format!("{}/{line}/status", hub.topic),
                        "value_template": "{{ 'online' if value == 'online' else 'offline' }}",
                    },
                ]),
            ),
            (
                "device",
                json!({
                    "identifiers": [format!("{gateway}_{line}")],
                    "name": format!("{gateway} {line}"),
                }),
            ),
        ];
        let described = described.map(|(key, value)| (key.to_owned(), value));
        (kind, id, described.into_iter().collect())
    }

    /// What shows a field of one kind of telegram or of an area.
    fn field(
        &self,
        kind: &'static str,
        id: String,
        event: &str,
        place: &Name,
        field: &Field,
    ) -> Entity {
        let name = format!("{place} {}", field.name);
        let (kind, id, mut entity) = self.entity(kind, id, &name);
        let mut set = |key: &str, value: Value| entity.insert(key.to_owned(), value);
        let state_topic = format!("{}/{}/{event}/{place}", self.hub.topic, self.line);
        let value = format!("{{{{ value_json.fields['{}'].value }}}}", field.name);
        set("state_topic", json!(state_topic));
        set("value_template", json!(value));
        if let Some(unit) = &field.unit {
            set("unit_of_measurement", json!(unit));
        }
        if let Some(class) = &field.device_class {
            set("device_class", json!(class));
        }
        (kind, id, entity)
    }

    fn sensor(&self, event: &str, place: &Name, field: &Field) -> Entity {
        let id = format!("{}_{place}_{}", self.line, field.name);
        let (kind, id, mut entity) = self.field("sensor", id, event, place, field);
        if let Some(class) = field.state_class() {
            entity.insert("state_class".to_owned(), json!(class));
        }
        (kind, id, entity)
    }

    fn number(&self, area: &Name, field: &Field) -> Option<Entity> {
        let (min, max, step) = field.scale_to_write()?;
        let id = format!("{}_{area}_{}_set", self.line, field.name);
        let (kind, id, mut entity) = self.field("number", id, "area", area, field);
        let command = format!(
            "{{\"write\": \"{area}\", \"fields\": {{\"{}\": {{{{ value }}}}}}}}",
            field.name
        );
        for (key, value) in [
            ("command_topic", json!(self.command_topic())),
            ("command_template", json!(command)),
            ("min", json!(min)),
            ("max", json!(max)),
            ("step", json!(step)),
        ] {
            entity.insert(key.to_owned(), value);
        }
        Some((kind, id, entity))
    }

    fn fetch_button(&self, area: &Name) -> Entity {
        let id = format!("{}_{area}_fetch", self.line);
        let (kind, id, mut entity) = self.entity("button", id, &format!("{area} fetch"));
        let press = json!({ "fetch": area }).to_string();
        entity.insert("command_topic".to_owned(), json!(self.command_topic()));
        entity.insert("payload_press".to_owned(), json!(press));
        (kind, id, entity)
    }

    fn command_topic(&self) -> String {
        format!("{}/{}/command", self.hub.topic, self.line)
    }
}
