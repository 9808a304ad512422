//! Where the broker is.

use core::{fmt, net::Ipv6Addr};

use serde::Deserialize;

/// `mqtt://HOST[:PORT]`, or `mqtts://HOST[:PORT]` over TLS; without a port 1883 and 8883. An
/// address of IPv6 is in brackets.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Broker {
    /// Without brackets.
    pub(crate) host: String,
    pub(crate) port: u16,
    pub(crate) is_tls: bool,
}

impl TryFrom<String> for Broker {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let no_broker = || format!("`{text}` is not mqtt://HOST[:PORT] or mqtts://HOST[:PORT]");
        let (is_tls, place) = match text.split_once("://") {
            Some(("mqtt", place)) => (false, place),
            Some(("mqtts", place)) => (true, place),
            _ => return Err(no_broker()),
        };
        let (host, port) = match place.rsplit_once(':') {
            // The last colon is one of an address without a port.
            Some(_) if place.ends_with(']') => (place, None),
            Some((host, port)) => (host, Some(port.parse().map_err(|_| no_broker())?)),
            None => (place, None),
        };
        let port = port.unwrap_or(if is_tls { 8883 } else { 1883 });
        let bracketed = host.strip_prefix('[').and_then(|it| it.strip_suffix(']'));
        let host = match bracketed {
            Some(address) if address.parse::<Ipv6Addr>().is_ok() => address,
            _ if host.is_empty() || host.contains(['/', ':', '@', ' ', '[', ']']) => {
                return Err(no_broker());
            }
            _ => host,
        };
        Ok(Self {
            host: host.to_owned(),
            port,
            is_tls,
        })
    }
}

impl fmt::Display for Broker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_tls { "mqtts" } else { "mqtt" };
        if self.host.contains(':') {
            write!(f, "{scheme}://[{}]:{}", self.host, self.port)
        } else {
            write!(f, "{scheme}://{}:{}", self.host, self.port)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses() {
        for (text, printed) in [
            ("mqtt://plant", "mqtt://plant:1883"),
            ("mqtts://plant", "mqtts://plant:8883"),
            ("mqtts://10.0.0.1:1", "mqtts://10.0.0.1:1"),
            ("mqtt://[::1]", "mqtt://[::1]:1883"),
            ("mqtts://[fd00::7]:1", "mqtts://[fd00::7]:1"),
        ] {
            let broker = Broker::try_from(text.to_owned()).unwrap();
            assert_eq!(broker.to_string(), printed);
        }
        for text in [
            "plant",
            "http://plant",
            "mqtt://",
            "mqtt://:1",
            "mqtt://u:p@h",
            "mqtt://h:x",
            "mqtt://::1",
            "mqtt://[h]",
            "mqtt://[::1",
            "mqtt://[::1]x",
        ] {
            let error = Broker::try_from(text.to_owned()).unwrap_err();
            let message = format!("`{text}` is not mqtt://HOST[:PORT] or mqtts://HOST[:PORT]");
            assert_eq!(error, message);
        }
    }
}
