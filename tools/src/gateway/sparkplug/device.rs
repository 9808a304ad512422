//! A line as a device: its metrics, and what this gateway's messages say of them.

use serde_json::{Map, Value as Json, json};
use toml::Spanned;

use super::{
    metric::DataType,
    payload::{Metric, Value},
};
use crate::gateway::{
    config::{Line, Procedure},
    field::Field,
};

/// Takes any command of the line, as JSON.
const COMMAND: &str = "command";

/// Counts of a line's health.
const COUNTS: [&str; 7] = [
    "received",
    "possible_repeats",
    "not_stored",
    "dead_letters",
    "commands_done",
    "commands_failed",
    "opened",
];

/// What a device has to tell, and what it has told last.
pub(super) struct Device {
    metrics: Vec<Known>,
    /// The line is open, and its partner answers.
    pub(super) is_up: bool,
    /// The birth is published.
    pub(super) is_born: bool,
}

struct Known {
    name: String,
    data_type: DataType,
    /// The area and the field that a command for it writes.
    writes: Option<(String, String)>,
    last: Option<(Value, u64)>,
}

impl Device {
    pub(super) fn new(line: &Line) -> Self {
        let mut device = Self {
            metrics: Vec::new(),
            is_up: false,
            is_born: false,
        };
        for name in ["status", "verdict", "run", "outcome", COMMAND] {
            device.add(name.to_owned(), DataType::String);
        }
        device.add("fault".to_owned(), DataType::Boolean);
        device.add("seq".to_owned(), DataType::UInt64);
        device.add("possible_repeat".to_owned(), DataType::Boolean);
        for count in COUNTS {
            device.add(format!("health/{count}"), DataType::UInt64);
        }
        if line.procedure == Procedure::Telegrams {
            device.add("telegram".to_owned(), DataType::Bytes);
        }
        for telegram in line.telegrams.iter().map(Spanned::get_ref) {
            device.add_place(&format!("telegram/{}", telegram.name), &telegram.fields);
        }
        for area in line.areas.iter().map(Spanned::get_ref) {
            let place = format!("area/{}", area.name);
            device.add_place(&place, &area.fields);
            if area.writable && !line.read_only {
                for field in area.fields.iter().map(Spanned::get_ref) {
                    let name = format!("{place}/{}", field.name);
                    let writes = (area.name.to_string(), field.name.to_string());
                    let known = device.metrics.iter_mut().find(|known| known.name == name);
                    if let Some(known) = known {
                        known.writes = Some(writes);
                    }
                }
            }
        }
        device
    }

    fn add(&mut self, name: String, data_type: DataType) {
        self.metrics.push(Known {
            name,
            data_type,
            writes: None,
            last: None,
        });
    }

    /// The bytes of a telegram or an area, and its fields.
    fn add_place(&mut self, place: &str, fields: &[Spanned<Field>]) {
        self.add(place.to_owned(), DataType::Bytes);
        for field in fields.iter().map(Spanned::get_ref) {
            self.add(format!("{place}/{}", field.name), field.data_type());
        }
    }

    /// All metrics with what was told of them last, for a birth.
    pub(super) fn birth(&self, now_ms: u64) -> Vec<Metric> {
        let metric = |known: &Known| {
            let (value, at_ms) = match &known.last {
                Some((value, at_ms)) => (Some(value.clone()), *at_ms),
                None => (None, now_ms),
            };
            metric(&known.name, known.data_type, value, at_ms, false)
        };
        self.metrics.iter().map(metric).collect()
    }

    /// The metrics of what has come, and keeps those that are not older than what it has.
    pub(super) fn told(
        &mut self,
        news: Vec<(String, Json)>,
        at_ms: u64,
        is_historical: bool,
    ) -> Vec<Metric> {
        let mut told = Vec::new();
        for (name, json) in news {
            let known = self.metrics.iter_mut().find(|known| known.name == name);
            if let Some(known) = known
                && let Some(value) = known.data_type.value(&json)
            {
                if known.last.as_ref().is_none_or(|(_, last)| *last <= at_ms) {
                    known.last = Some((value.clone(), at_ms));
                }
                let value = Some(value);
                told.push(metric(&name, known.data_type, value, at_ms, is_historical));
            }
        }
        told
    }

    /// What a message of this line says, by the names of metrics: `kind` is its topic behind the
    /// line's. `None` where the device has nothing of that kind.
    pub(super) fn read(&self, kind: &str, payload: &[u8]) -> Option<Vec<(String, Json)>> {
        if kind == "status" || kind == "outcome" {
            let text = String::from_utf8_lossy(payload);
            return Some(vec![(kind.to_owned(), text.into())]);
        }
        let mut json: Map<String, Json> = serde_json::from_slice(payload).ok()?;
        let mut get = |key: &str| json.remove(key).unwrap_or_default();
        match kind {
            "health" => {
                let counts = COUNTS.map(|count| (format!("health/{count}"), get(count)));
                return Some(counts.to_vec());
            }
            "verdict" => {
                let news = [("verdict", get("sentence")), ("fault", get("is_fault"))];
                return Some(news.map(|(name, value)| (name.to_owned(), value)).to_vec());
            }
            _ => {}
        }
        // A kind of telegram that is configured no longer is one that nothing describes.
        let has = |place: &str| self.metrics.iter().any(|known| known.name == place);
        let place = match kind.split_once('/') {
            _ if has(kind) => kind,
            Some(("telegram", _)) if has("telegram") => "telegram",
            _ => return None,
        };
        let mut news = vec![
            ("run".to_owned(), get("run")),
            ("seq".to_owned(), get("seq")),
            (
                "possible_repeat".to_owned(),
                (get("possible_repeat") == Json::Bool(true)).into(),
            ),
            (place.to_owned(), get("hex")),
        ];
        if let Json::Object(fields) = get("fields") {
            for (field, mut decoded) in fields {
                let value = decoded.get_mut("value").map(Json::take);
                news.push((format!("{place}/{field}"), value.unwrap_or_default()));
            }
        }
        Some(news)
    }

    /// The command, as JSON, that a metric is which came for this device.
    ///
    /// # Errors
    /// A metric that takes none.
    pub(super) fn command(&self, name: &str, value: Option<&Value>) -> Result<String, String> {
        let known = self.metrics.iter().find(|known| known.name == name);
        let known = known.ok_or_else(|| format!("there is no metric `{name}`"))?;
        let json = value.and_then(|value| known.data_type.json(value));
        let json = json.ok_or_else(|| format!("`{name}` is of type {:?}", known.data_type))?;
        match (&known.writes, json) {
            (Some((area, field)), json) => {
                Ok(json!({ "write": area, "fields": { field: json } }).to_string())
            }
            (None, Json::String(command)) if name == COMMAND => Ok(command),
            _ => Err(format!("`{name}` takes no commands")),
        }
    }
}

fn metric(
    name: &str,
    data_type: DataType,
    value: Option<Value>,
    at_ms: u64,
    is_historical: bool,
) -> Metric {
    Metric {
        name: Some(name.to_owned()),
        timestamp: Some(at_ms),
        datatype: Some(data_type as u32),
        is_historical: is_historical.then_some(true),
        is_null: value.is_none().then_some(true),
        value,
    }
}
