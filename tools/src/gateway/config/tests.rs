use std::fs;

use super::Config;

const HEAD: &str = "name = \"hall\"\n[tcp]\nlisten = \"127.0.0.1:0\"\n";
const LINE: &str = "[[line]]\nname = \"a\"\nport = \"tcp://h:1?baud=9600\"\npriority = \"low\"\n";
const RK512: &str = "[[line]]\nname = \"a\"\nport = \"tcp://h:1?baud=9600\"\npriority = \"low\"\n\
                     procedure = \"rk512\"\n[[line.area]]\nname = \"x\"\nstart = \"DB 1.0\"\nlength = 4\n";

fn error(text: &str) -> String {
    match Config::parse(text) {
        Ok(_) => panic!("{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn the_page_on_the_gateway_has_a_configuration_that_holds() {
    // The published package is without it.
    let Ok(page) = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../docs/book/src/gateway.md"
    )) else {
        eprintln!("skipped: there is no docs/book/src/gateway.md");
        return;
    };
    let blocks = page.split("```toml\n").skip(1);
    let mut blocks = blocks.map(|block| block.split("```").next().unwrap());
    let config = Config::parse(blocks.next().unwrap()).unwrap();
    assert_eq!(config.lines.len(), 2);
    let sparkplug = blocks.next().unwrap();
    let config = Config::parse(&format!("name = \"hall-3\"\n{sparkplug}{LINE}")).unwrap();
    assert!(config.mqtt().unwrap().sparkplug.is_some());
    let nats = blocks.next().unwrap();
    let config = Config::parse(&format!("name = \"hall-3\"\n{nats}{LINE}")).unwrap();
    assert_eq!(config.broker().unwrap().kind(), "nats");
}

#[test]
fn errors_name_line_and_column() {
    for (rest, message) in [
        (
            "[[line]]\nport = \"COM3\"",
            "line 4, column 1: missing field `name`",
        ),
        (
            "x = 1",
            "line 4, column 1: unknown field `x`, expected `listen`",
        ),
        (
            &LINE.replace("\"a\"", "\"a b\""),
            "line 5, column 8: `a b` is not 1 to 64 of A-Z a-z 0-9 _ -",
        ),
        (
            &LINE.replace("h:1", "h"),
            "line 6, column 8: `tcp://h?baud=9600`: `h` is not HOST:PORT",
        ),
        (
            &(LINE.to_owned() + &LINE.replace("h:1", "h:2")),
            "line 9, column 8: a second line `a`",
        ),
        (
            &(LINE.to_owned() + &LINE.replace("\"a\"", "\"b\"")),
            "line 8, column 1: a second line on `tcp://h:1`",
        ),
        (
            &(LINE.to_owned() + &LINE.replace("\"a\"", "\"b\"").replace("tcp:", "rfc2217:")),
            "line 8, column 1: a second line on `rfc2217://h:1`",
        ),
        (
            &format!("{LINE}[[line.telegram]]\nname = \"x\"\nstarts_with = \"5\""),
            "line 10, column 15: `5` is not made of whole bytes",
        ),
        (
            &format!(
                "{LINE}[[line.telegram]]\nname = \"x\"\nstarts_with = \"57\"\n\
                 [[line.telegram]]\nname = \"y\"\nstarts_with = \"57 01\"\nlength = 3"
            ),
            "line 11, column 1: telegram `y`: `x` describes all of them before",
        ),
        (
            &LINE.replace("?baud=9600", ""),
            "line 4, column 1: `tcp://h:1`: the rate of its serial line is not known: \
             `?baud=9600`, or `?line=instant` where no wire is in between",
        ),
        (
            &format!("{LINE}silent_after_s = 0"),
            "line 8, column 18: silent_after_s: 0 is no time in seconds, up to 1000000000",
        ),
        (
            &format!("{LINE}qvz_ms = 0"),
            "line 8, column 10: invalid value: integer `0`, expected a nonzero u16",
        ),
        (
            &format!(
                "{LINE}[[line.telegram]]\nname = \"x\"\nlength = 2\nfield = [{{ name = \"y\", offset = 1, type = \"u16be\" }}]"
            ),
            "line 11, column 10: field `y`: ends at byte 3 of 2",
        ),
        (
            &format!(
                "{LINE}procedure = \"rk512\"\n[[line.area]]\nname = \"x\"\nstart = \"DB 1.0\"\nlength = 1\n\
                 field = [{{ name = \"y\", offset = 1, type = \"u16be\" }}]"
            ),
            "line 13, column 10: field `y`: ends at byte 3 of 2",
        ),
        (
            &format!("{RK512}served = true\npoll_s = 1"),
            "line 9, column 1: poll_s: a served area is not fetched",
        ),
        (
            &format!("{RK512}served = true\ncoordination_flag = \"1.2\""),
            "line 9, column 1: coordination_flag: the partner's commands bring it",
        ),
        (
            &format!("{RK512}coordination_flag = \"1.8\""),
            "line 13, column 21: `1.8` is not BYTE.BIT, 0.0 to 254.7",
        ),
        (
            &format!(
                "{RK512}served = true\n[[line.area]]\nname = \"y\"\nstart = \"DB 1.3\"\nlength = 9\n\
                 served = true"
            ),
            "line 14, column 1: area `y`: `x` has some of it",
        ),
        (
            &format!("{LINE}[[line.area]]\nname = \"x\"\nstart = \"DB 1.0\"\nlength = 1"),
            "line 8, column 1: areas are for procedure = \"rk512\"",
        ),
        (
            &format!(
                "{LINE}[[line.telegram]]\nname = \"x\"\nfield = [{{ name = \"y\", offset = 0, type = \"text\" }}]"
            ),
            "line 10, column 10: field `y`: this type needs a length",
        ),
        (
            &format!(
                "{LINE}procedure = \"rk512\"\n[[line.area]]\nname = \"x\"\nstart = \"DB 1\"\nlength = 1"
            ),
            "line 11, column 9: `DB 1` is none of `DB N.WORD`, `DX N.WORD`, `inputs BYTE`, \
             `outputs BYTE`, `flags BYTE`, `timers N`, `counters N`",
        ),
    ] {
        assert_eq!(error(&format!("{HEAD}{rest}\n")), message);
    }
    let listening = |tcp: &str, metrics: &str| {
        let head = HEAD.replace("127.0.0.1:0", tcp);
        format!("{head}[metrics]\nlisten = \"{metrics}\"\n{LINE}")
    };
    for both in [
        ["127.0.0.1:9", "127.0.0.1:9"],
        ["0.0.0.0:9", "127.0.0.1:9"],
        ["127.0.0.1:9", "[::]:9"],
    ] {
        let [tcp, metrics] = both;
        let message = format!("line 4, column 1: tcp listens on {tcp} too");
        assert_eq!(error(&listening(tcp, metrics)), message);
    }
    for [tcp, metrics] in [["127.0.0.2:9", "127.0.0.1:9"], ["0.0.0.0:9", "[::1]:9"]] {
        assert!(Config::parse(&listening(tcp, metrics)).is_ok());
    }
    let mqtt = |rest| format!("name = \"hall\"\n[mqtt]\nbroker = \"mqtt://h\"\n{rest}\n{LINE}");
    for (rest, message) in [
        ("password = \"x\"", "mqtt: a password without a user"),
        (
            "key_file = \"x\"",
            "mqtt: certificate_file and key_file go together",
        ),
        ("ca_file = \"x\"", "mqtt: certificates are for mqtts://"),
        (
            "protocol = \"3.1.1\"\ncommand_max_age_s = 1",
            "mqtt: command_max_age_s is for MQTT 5",
        ),
        ("keep_alive_s = 4", "mqtt: keep_alive_s: 4, at least 5"),
        (
            "queue = 10",
            "mqtt: queue is for [store] with sync = \"none\"",
        ),
    ] {
        assert_eq!(error(&mqtt(rest)), format!("line 2, column 1: {message}"));
    }
    let nats =
        |servers, rest| format!("name = \"hall\"\n[nats]\nservers = [{servers}]\n{rest}\n{LINE}");
    for (servers, rest, message) in [
        ("", "", "line 2, column 1: nats: servers: none"),
        (
            "\"http://h\"",
            "",
            "line 3, column 11: `http://h` is not nats://HOST[:PORT] or tls://HOST[:PORT]",
        ),
        (
            "\"nats://h\"",
            "password = \"x\"",
            "line 2, column 1: nats: a password without a user",
        ),
        (
            "\"nats://h\"",
            "ca_file = \"x\"",
            "line 2, column 1: nats: certificates are for tls://",
        ),
        (
            "\"nats://h\"",
            "prefix = \"a.b\"",
            "line 2, column 1: nats: prefix: no level of a subject has `.`, `*`, `>` or a space",
        ),
        (
            "\"nats://h\"",
            "duplicate_window_s = 0",
            "line 2, column 1: nats: duplicate_window_s: 0 is no time in seconds, up to 1000000000",
        ),
        (
            "\"nats://h\"",
            "[mqtt]\nbroker = \"mqtt://h\"",
            "line 2, column 1: [mqtt] and [nats]",
        ),
    ] {
        assert_eq!(error(&nats(servers, rest)), message);
    }
    assert_eq!(
        error(&mqtt("[metrics]\nlisten = \"[::1]:0\"").replacen('[', "stop_s = -1\n[", 1)),
        "line 2, column 10: stop_s: -1 is no time in seconds, up to 1000000000"
    );
    assert_eq!(
        error(&mqtt("prefix = \"a/#\"")),
        "line 4, column 10: `a/#` is no beginning of a topic"
    );
    assert_eq!(
        error(&mqtt("protocol = \"4\"")),
        "line 4, column 12: unknown variant `4`, expected `3.1.1` or `5`"
    );
}

#[test]
fn what_sparkplug_has_no_place_for_is_refused() {
    for (key, message) in [
        (
            "discovery = \"homeassistant\"",
            "mqtt: discovery: its topics are not published with Sparkplug",
        ),
        (
            "command_max_age_s = 5",
            "mqtt: command_max_age_s: Sparkplug keeps no commands",
        ),
    ] {
        let text = format!(
            "name = \"hall\"\n[mqtt]\nbroker = \"mqtt://h\"\n{key}\n\
             [mqtt.sparkplug]\ngroup = \"plant\"\n{LINE}"
        );
        assert!(error(&text).ends_with(message), "{}", error(&text));
    }
}
