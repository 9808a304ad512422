//! Areas of an RK512 partner by their configuration.

use core::{ops::Range, time::Duration};

use rk512::{AreaKind, Coordination, CoordinationFlag};
use serde::Deserialize;
use serde_json::{Map, Value};
use toml::Spanned;

use super::{config::Name, field::Field, job::Data, time::duration};

/// What a client fetches at once, at most.
const MAX_BYTES: usize = 4096;

/// What is fetched at once.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Area {
    pub(crate) name: Name,
    /// Where it begins.
    pub(crate) start: Start,
    /// Words or bytes, as the area counts.
    pub(crate) length: u16,
    /// Seconds from one poll to the next; without it, on command only.
    poll_s: Option<f64>,
    /// Whether commands may write it.
    #[serde(default)]
    pub(crate) writable: bool,
    /// Whether it is the gateway's own, from which the partner fetches and to which it sends.
    #[serde(default)]
    pub(crate) served: bool,
    /// Of the commands that go to the partner.
    coordination_flag: Option<Flag>,
    #[serde(default, rename = "field")]
    pub(crate) fields: Vec<Spanned<Field>>,
}

/// An address in the partner's memory: `DB 10.0`, `DX 3.5`, `flags 20`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Start(pub(crate) rk512::Area);

impl TryFrom<String> for Start {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let no_address = || {
            format!(
                "`{text}` is none of `DB N.WORD`, `DX N.WORD`, `inputs BYTE`, `outputs BYTE`, \
                 `flags BYTE`, `timers N`, `counters N`"
            )
        };
        let (area, place) = text.split_once(' ').ok_or_else(no_address)?;
        let number = |text: &str| text.parse::<u8>().map_err(|_| no_address());
        let block = |kind| {
            let (block, word) = place.split_once('.').ok_or_else(no_address)?;
            rk512::Area::new(kind, number(block)?, number(word)?).map_err(|e| e.to_string())
        };
        let area = match area {
            "DB" => block(AreaKind::DataBlock)?,
            "DX" => block(AreaKind::ExtendedDataBlock)?,
            "inputs" => rk512::Area::inputs(number(place)?),
            "outputs" => rk512::Area::outputs(number(place)?),
            "flags" => rk512::Area::flags(number(place)?),
            "timers" => rk512::Area::timers(number(place)?),
            "counters" => rk512::Area::counters(number(place)?),
            _ => return Err(no_address()),
        };
        Ok(Self(area))
    }
}

/// A coordination flag: `20.3` is bit 3 of flag byte 20.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
struct Flag(CoordinationFlag);

impl TryFrom<String> for Flag {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not BYTE.BIT, 0.0 to 254.7");
        let (byte, bit) = text.split_once('.').ok_or_else(wrong)?;
        let number = |text: &str| text.parse::<u8>().map_err(|_| wrong());
        let flag = CoordinationFlag::new(number(byte)?, number(bit)?);
        flag.map(Self).map_err(|_| wrong())
    }
}

impl Area {
    pub(super) fn check(&self) -> Result<(), String> {
        if self.served && self.poll_s.is_some() {
            return Err("poll_s: a served area is not fetched".to_owned());
        }
        if self.served && self.coordination_flag.is_some() {
            return Err("coordination_flag: the partner's commands bring it".to_owned());
        }
        if self.served {
            return self.check_size();
        }
        rk512::Command::fetch(self.start.0, self.length).map_err(|error| error.to_string())?;
        if self.writable {
            rk512::Command::send(self.start.0, self.length).map_err(|error| error.to_string())?;
        }
        if let Some(seconds) = self.poll_s {
            duration(seconds).map_err(|message| format!("poll_s: {message}"))?;
        }
        self.check_size()
    }

    fn check_size(&self) -> Result<(), String> {
        match self.bytes() {
            0 => Err("length: 0".to_owned()),
            bytes if bytes > MAX_BYTES => {
                Err(format!("{bytes} bytes, at most {MAX_BYTES} at once"))
            }
            _ => Ok(()),
        }
    }

    /// Whether both have a word or byte in common.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let (one, two) = (self.start.0, other.start.0);
        let (own, its) = (self.units(), other.units());
        one.kind() == two.kind()
            && one.number() == two.number()
            && own.start < its.end
            && its.start < own.end
    }

    /// Words or bytes, as the area counts.
    pub(super) fn units(&self) -> Range<usize> {
        let start = usize::from(self.start.0.start());
        start..start + usize::from(self.length)
    }

    /// What the gateway's own commands bring.
    pub(super) fn coordination(&self) -> Coordination {
        let flag = self.coordination_flag.map(|flag| flag.0);
        flag.map_or_else(Coordination::default, Coordination::from)
    }

    /// Bytes of the whole area.
    pub(super) fn bytes(&self) -> usize {
        usize::from(self.length) * self.start.0.kind().bytes_per_unit()
    }

    pub(super) fn poll(&self) -> Option<Duration> {
        duration(self.poll_s?).ok()
    }
}

impl Area {
    /// What is to be written where, in whole words.
    pub(super) fn blocks(&self, data: Data) -> Result<Vec<(rk512::Area, Vec<u8>)>, String> {
        let name = &self.name;
        if !self.writable {
            return Err(format!("`{name}` is not writable"));
        }
        match data {
            Data::Bytes(bytes) if bytes.is_empty() || bytes.len() > self.bytes() => {
                let (len, most) = (bytes.len(), self.bytes());
                Err(format!("{len} bytes for `{name}`, 2 to {most} fit"))
            }
            Data::Bytes(bytes) => Ok(vec![(self.start.0, bytes)]),
            Data::Fields(fields) => self.field_blocks(&fields),
        }
    }

    /// Writes into an area that is served.
    pub(super) fn patch(&self, data: Data, area: &mut [u8]) -> Result<(), String> {
        let name = &self.name;
        if !self.writable {
            return Err(format!("`{name}` is not writable"));
        }
        match data {
            Data::Bytes(bytes) => {
                let (len, most) = (bytes.len(), area.len());
                let place = area.get_mut(..len).filter(|place| !place.is_empty());
                place
                    .ok_or_else(|| format!("{len} bytes for `{name}`, 1 to {most} fit"))?
                    .copy_from_slice(&bytes);
            }
            Data::Fields(fields) => {
                for (name, value) in &fields {
                    let put = self.field(name)?.put(value, area);
                    put.map_err(|error| format!("`{name}`: {error}"))?;
                }
            }
        }
        Ok(())
    }

    fn field(&self, name: &str) -> Result<&Field, String> {
        let mut fields = self.fields.iter().map(Spanned::get_ref);
        fields
            .find(|field| field.name.as_str() == name)
            .ok_or_else(|| format!("no field `{name}` in `{}`", self.name))
    }

    fn field_blocks(
        &self,
        values: &Map<String, Value>,
    ) -> Result<Vec<(rk512::Area, Vec<u8>)>, String> {
        let mut blocks = Vec::new();
        for (name, value) in values {
            let field = self.field(name)?;
            if !field.is_made_of_words() {
                return Err(format!("`{name}` is not made of whole words"));
            }
            let bytes = field
                .encode(value)
                .map_err(|error| format!("`{name}`: {error}"))?;
            blocks.push((self.place(field.range().start / 2)?, bytes));
        }
        Ok(blocks)
    }

    /// The address of a word of the area.
    fn place(&self, word: usize) -> Result<rk512::Area, String> {
        let start = self.start.0;
        let word = u8::try_from(usize::from(start.start()) + word)
            .map_err(|_| format!("no address for word {word} of `{}`", self.name))?;
        rk512::Area::new(start.kind(), start.number(), word).map_err(|error| error.to_string())
    }
}
