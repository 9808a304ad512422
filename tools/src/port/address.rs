//! One syntax for the ports of all programs.

use core::{fmt, str::FromStr};

use proto3964r::Line;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Frame, Parity};

/// A port, by its address.
///
/// | address | port | [`line`](Self::line) |
/// |---|---|---|
/// | `/dev/ttyUSB0` | a serial port, or another program's pseudo-terminal | [`Line::Buffered`] |
/// | `tcp://HOST:PORT` | a serial server in raw mode, which is connected to | [`Line::Buffered`] |
/// | `rfc2217://HOST:PORT` | a serial server that is set up over the connection (RFC 2217) | [`Line::Buffered`] |
/// | `tcp-listen://HOST:PORT` | one program that connects here | [`Line::Instant`] |
/// | `pty:PATH` | a new pseudo-terminal, whose other end another program opens as `PATH` | [`Line::Instant`] |
///
/// Settings follow after `?`, with `&` between them, as in `/dev/ttyUSB0?baud=19200&parity=none`:
///
/// | setting | values | default |
/// |---|---|---|
/// | `baud` | bits per second | 9600; of `tcp://` none, since its line has one that is not known here |
/// | `parity` | `none`, `even`, `odd` | `even` |
/// | `stop` | stop bits: `1`, `2` | 1 |
/// | `line` | `instant` where no wire is in between, `buffered` at these bits per second | see above |
/// | `echo` | `keep`; `remove` on a two-wire line, where each side hears itself | `keep` |
///
/// A port that nothing can be taken back from is never [`Line::Paced`].
///
/// # Examples
/// ```
/// use line3964r::{Address, Target};
/// use proto3964r::Line;
///
/// # fn main() -> Result<(), line3964r::AddressError> {
/// let address: Address = "tcp://192.168.0.7:4001?baud=19200".parse()?;
/// assert_eq!(address.target, Target::Tcp("192.168.0.7:4001".to_owned()));
/// assert_eq!(address.line()?, Line::buffered(19200, 11));
///
/// let error = "tcp://plc?baud=fast".parse::<Address>().unwrap_err();
/// assert_eq!(error.to_string(), "`tcp://plc?baud=fast`: `plc` is not HOST:PORT");
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
#[expect(clippy::exhaustive_structs, reason = "plain settings")]
pub struct Address {
    /// What is opened.
    pub target: Target,
    /// How its characters are made.
    pub frame: Frame,
    /// Whether the rate of the line is known: of `tcp://` where it was given.
    pub has_rate: bool,
    /// What is in between, where it was given.
    pub wire: Option<Wire>,
    /// Whether each side hears itself, and that is to be removed.
    pub has_echo: bool,
}

/// What lies between this program and its partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "a wire or none")]
pub enum Wire {
    /// None: answers may come at once.
    Instant,
    /// One behind a buffer.
    Buffered,
}

/// What an address names.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Target {
    /// A serial port, by its path or name.
    Serial(String),
    /// A serial server in raw mode, `HOST:PORT`.
    Tcp(String),
    /// A serial server that speaks RFC 2217, `HOST:PORT`.
    Rfc2217(String),
    /// Whoever connects to `HOST:PORT` of this machine.
    TcpListen(String),
    /// A new pseudo-terminal, linked at this path.
    Pty(String),
}

/// What is wrong with an address, and where.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{address}`: {message}")]
#[non_exhaustive]
pub struct AddressError {
    /// The address.
    pub address: String,
    /// What is wrong with it.
    pub message: String,
}

impl Address {
    /// What a station has to know of the line: see the table above.
    ///
    /// # Errors
    /// The rate of the line behind a serial server in raw mode, where it was not given: with
    /// another one answers are taken for old ones, or late ones for new.
    pub fn line(&self) -> Result<Line, AddressError> {
        if self.is_instant() {
            Ok(Line::Instant)
        } else if self.has_rate {
            Ok(Line::buffered(self.frame.baud, self.frame.bits()))
        } else {
            Err(AddressError {
                address: self.to_string(),
                message: "the rate of its serial line is not known: `?baud=9600`, or \
                          `?line=instant` where no wire is in between"
                    .to_owned(),
            })
        }
    }

    fn is_instant(&self) -> bool {
        let given = self.wire.map(|wire| wire == Wire::Instant);
        given.unwrap_or_else(|| self.target.is_instant())
    }
}

impl Target {
    fn parse(text: &str) -> Result<Self, String> {
        if let Some(path) = text.strip_prefix("pty:") {
            return match path {
                "" => Err("no path after `pty:`".to_owned()),
                path => Ok(Self::Pty(path.to_owned())),
            };
        }
        match text.split_once("://") {
            Some(("tcp", host)) => host_and_port(host).map(Self::Tcp),
            Some(("rfc2217", host)) => host_and_port(host).map(Self::Rfc2217),
            Some(("tcp-listen", host)) => host_and_port(host).map(Self::TcpListen),
            Some((scheme, _)) => Err(format!(
                "`{scheme}` is none of tcp, rfc2217, tcp-listen; pty and serial ports have no `//`"
            )),
            None if text.is_empty() => Err("no port".to_owned()),
            None => Ok(Self::Serial(text.to_owned())),
        }
    }

    /// No wire lies between this program and who opens or calls this.
    const fn is_instant(&self) -> bool {
        matches!(self, Self::Pty(_) | Self::TcpListen(_))
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial(path) => f.write_str(path),
            Self::Tcp(host) => write!(f, "tcp://{host}"),
            Self::Rfc2217(host) => write!(f, "rfc2217://{host}"),
            Self::TcpListen(host) => write!(f, "tcp-listen://{host}"),
            Self::Pty(path) => write!(f, "pty:{path}"),
        }
    }
}

fn host_and_port(text: &str) -> Result<String, String> {
    let parts = text.rsplit_once(':');
    match parts.map(|(host, port)| (host, port.parse::<u16>())) {
        Some((host, Ok(_))) if !host.is_empty() => Ok(text.to_owned()),
        _ => Err(format!("`{text}` is not HOST:PORT")),
    }
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        parse(text).map_err(|message| AddressError {
            address: text.to_owned(),
            message,
        })
    }
}

fn parse(text: &str) -> Result<Address, String> {
    let (target, settings) = match text.split_once('?') {
        Some((target, settings)) => (target, Some(settings)),
        None => (text, None),
    };
    let target = Target::parse(target)?;
    let mut address = Address {
        has_rate: !matches!(target, Target::Tcp(_)),
        wire: None,
        target,
        frame: Frame::DEFAULT,
        has_echo: false,
    };
    let settings = settings.into_iter().flat_map(|list| list.split('&'));
    let mut seen: Vec<&str> = Vec::new();
    for setting in settings {
        let (name, value) = setting
            .split_once('=')
            .ok_or_else(|| format!("`{setting}` is not NAME=VALUE"))?;
        if seen.contains(&name) {
            return Err(format!("{name} is set twice"));
        }
        seen.push(name);
        address.set(name, value)?;
    }
    Ok(address)
}

impl Address {
    fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let is_none_of = |values| Err(format!("{name}: `{value}` is none of {values}"));
        match (name, value) {
            ("baud", _) => match value.parse() {
                Ok(0) | Err(_) => return Err(format!("baud: `{value}` is no number of bit/s")),
                Ok(baud) => (self.frame.baud, self.has_rate) = (baud, true),
            },
            ("parity", "none") => self.frame.parity = Parity::None,
            ("parity", "even") => self.frame.parity = Parity::Even,
            ("parity", "odd") => self.frame.parity = Parity::Odd,
            ("parity", _) => return is_none_of("none, even, odd"),
            ("stop", "1") => self.frame.stop_bits = 1,
            ("stop", "2") => self.frame.stop_bits = 2,
            ("stop", _) => return is_none_of("1, 2"),
            ("line", "instant") => self.wire = Some(Wire::Instant),
            ("line", "buffered") => self.wire = Some(Wire::Buffered),
            ("line", _) => return is_none_of("instant, buffered"),
            ("echo", "keep") => self.has_echo = false,
            ("echo", "remove") => self.has_echo = true,
            ("echo", _) => return is_none_of("keep, remove"),
            _ => {
                return Err(format!(
                    "`{name}` is none of baud, parity, stop, line, echo"
                ));
            }
        }
        Ok(())
    }
}

/// The shortest address that is equal to this one.
impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.target)?;
        let Frame {
            baud,
            parity,
            stop_bits,
        } = self.frame;
        let parity = match parity {
            Parity::Even => None,
            Parity::None => Some("parity=none"),
            Parity::Odd => Some("parity=odd"),
        };
        let line = self.wire.map(|wire| match wire {
            Wire::Instant => "line=instant",
            Wire::Buffered => "line=buffered",
        });
        let is_given = matches!(self.target, Target::Tcp(_)) && self.has_rate;
        let is_shown = is_given || baud != Frame::DEFAULT.baud;
        let baud = is_shown.then(|| format!("baud={baud}"));
        let settings = [
            baud.as_deref(),
            parity,
            (stop_bits != Frame::DEFAULT.stop_bits).then_some("stop=2"),
            line,
            self.has_echo.then_some("echo=remove"),
        ];
        let mut separator = '?';
        for setting in settings.into_iter().flatten() {
            write!(f, "{separator}{setting}")?;
            separator = '&';
        }
        Ok(())
    }
}

impl TryFrom<String> for Address {
    type Error = AddressError;

    fn try_from(text: String) -> Result<Self, AddressError> {
        text.parse()
    }
}

impl From<Address> for String {
    fn from(address: Address) -> Self {
        address.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings() {
        let address: Address = "/dev/ttyS1?baud=115200&parity=odd&stop=2&line=instant&echo=remove"
            .parse()
            .unwrap();
        assert_eq!(address.target, Target::Serial("/dev/ttyS1".to_owned()));
        let frame = Frame {
            baud: 115_200,
            parity: Parity::Odd,
            stop_bits: 2,
        };
        assert_eq!((address.frame, address.frame.bits()), (frame, 12));
        assert_eq!(address.line(), Ok(Line::Instant));
        assert!(address.has_echo);
    }

    #[test]
    fn lines() {
        let buffered = Line::buffered(9600, 11);
        for (text, line) in [
            ("COM3", buffered),
            ("tcp://plc.local:4001?baud=9600", buffered),
            ("rfc2217://[::1]:2217", buffered),
            ("tcp-listen://127.0.0.1:0", Line::Instant),
            ("pty:/tmp/line", Line::Instant),
            ("pty:/tmp/line?line=buffered", buffered),
        ] {
            let address: Address = text.parse().unwrap();
            assert_eq!(address.line(), Ok(line), "{text}");
            assert_eq!(address.to_string(), text);
        }
    }

    /// At 19200 bit/s a station that took 9600 for granted failed 7 of 10 jobs.
    #[test]
    fn no_rate_is_guessed() {
        let text = "tcp://plc.local:4001?parity=none";
        let address: Address = text.parse().unwrap();
        let error = address.line().unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "`{text}`: the rate of its serial line is not known: `?baud=9600`, or \
                 `?line=instant` where no wire is in between"
            )
        );
    }

    #[test]
    fn what_is_printed_reads_back() {
        for parity in ["", "&parity=none", "&parity=odd"] {
            for rest in ["", "&stop=2", "&line=instant", "&echo=remove&stop=2"] {
                let text = format!("tcp://h:1?baud=300{parity}{rest}");
                let address: Address = text.parse().unwrap();
                assert_eq!(address.to_string().parse(), Ok(address), "{text}");
            }
        }
    }

    #[test]
    fn errors_name_the_place_and_the_value() {
        for (text, message) in [
            ("", "no port"),
            ("pty:", "no path after `pty:`"),
            ("tcp://plc", "`plc` is not HOST:PORT"),
            ("tcp://:4001", "`:4001` is not HOST:PORT"),
            ("tcp://plc:65536", "`plc:65536` is not HOST:PORT"),
            (
                "udp://plc:1",
                "`udp` is none of tcp, rfc2217, tcp-listen; pty and serial ports have no `//`",
            ),
            ("COM3?baud", "`baud` is not NAME=VALUE"),
            ("COM3?", "`` is not NAME=VALUE"),
            ("COM3?baud=0", "baud: `0` is no number of bit/s"),
            (
                "COM3?baud=4294967296",
                "baud: `4294967296` is no number of bit/s",
            ),
            ("COM3?baud=1&baud=2", "baud is set twice"),
            (
                "COM3?parity=mark",
                "parity: `mark` is none of none, even, odd",
            ),
            ("COM3?stop=1.5", "stop: `1.5` is none of 1, 2"),
            (
                "COM3?line=paced",
                "line: `paced` is none of instant, buffered",
            ),
            ("COM3?echo=1", "echo: `1` is none of keep, remove"),
            (
                "COM3?speed=1",
                "`speed` is none of baud, parity, stop, line, echo",
            ),
        ] {
            let error = text.parse::<Address>().unwrap_err();
            assert_eq!(error.to_string(), format!("`{text}`: {message}"));
        }
    }
}
