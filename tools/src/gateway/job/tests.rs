use serde_json::json;

use super::*;

fn parse(command: &str) -> Result<Job, Refused> {
    Job::parse(command.as_bytes(), None)
}

/// What asks for no reply.
fn asked(id: Option<Value>) -> Asked {
    let id = id.map(|id| serde_json::from_str(&id.to_string()).unwrap());
    Asked { id, reply: None }
}

#[test]
fn each_action() {
    let write = |data| Action::Write {
        area: "oven".to_owned(),
        data,
    };
    let fields = Map::from_iter([("setpoint".to_owned(), json!(21.5))]);
    for (command, id, action) in [
        (
            r#"{"send": "54 41 5245"}"#,
            None,
            Action::Send(b"TARE".to_vec()),
        ),
        (r#"{"send": ""}"#, None, Action::Send(Vec::new())),
        (
            r#"{"id": 7, "send_text": "Öl"}"#,
            Some(json!(7)),
            Action::Send("Öl".as_bytes().to_vec()),
        ),
        (
            r#"{"fetch": "oven", "id": {"order":[1,"a"]}}"#,
            Some(json!({ "order": [1, "a"] })),
            Action::Fetch {
                area: "oven".to_owned(),
            },
        ),
        (
            r#"{"write": "oven", "hex": "00 2A"}"#,
            None,
            write(Data::Bytes(vec![0, 0x2A])),
        ),
        (
            r#"{"write": "oven", "fields": {"setpoint": 21.5}}"#,
            None,
            write(Data::Fields(fields)),
        ),
    ] {
        let asked = asked(id);
        assert_eq!(parse(command), Ok(Job { asked, action }), "{command}");
    }
}

/// Every command that names other things than one action does.
#[test]
fn half_an_action_and_two_at_once_are_refused() {
    const PARTS: [&str; 6] = [
        r#""send": "41""#,
        r#""send_text": "A""#,
        r#""fetch": "a""#,
        r#""write": "a""#,
        r#""hex": "41""#,
        r#""fields": {"a": 1}"#,
    ];
    const WHOLE: [u32; 5] = [0b1, 0b10, 0b100, 0b01_1000, 0b10_1000];
    for set in 0..1_u32 << PARTS.len() {
        let parts = PARTS
            .iter()
            .enumerate()
            .filter(|(bit, _)| set >> bit & 1 == 1);
        let parts: Vec<_> = parts.map(|(_, part)| *part).collect();
        let parsed = parse(&format!("{{\"id\": 1, {}}}", parts.join(", ")).replace(", }", "}"));
        if WHOLE.contains(&set) {
            assert!(parsed.is_ok(), "{parts:?}");
            continue;
        }
        let message = "one of send, send_text, fetch, write with hex, write with fields";
        let refused = Refused {
            asked: asked(Some(json!(1))),
            message: message.to_owned(),
        };
        assert_eq!(parsed, Err(refused), "{parts:?}");
    }
}

#[test]
fn what_is_no_command_is_told_with_its_place() {
    for (command, message) in [
        (
            "",
            "no command: EOF while parsing a value at line 1 column 0",
        ),
        ("TARE", "no command: expected value at line 1 column 1"),
        (
            "[1]",
            "no command: invalid length 1, expected a JSON object at line 1 column 3",
        ),
        (
            r#"{"send": 41}"#,
            "no command: invalid type: integer `41`, expected a string at line 1 column 11",
        ),
        (
            r#"{"send": "41"} {}"#,
            "no command: trailing characters at line 1 column 16",
        ),
        (
            r#"{"send": "41", "send": "42"}"#,
            "no command: duplicate field `send` at line 1 column 21",
        ),
        (
            r#"{"sent": "41"}"#,
            "no command: unknown field `sent`, expected one of `id`, `send`, `send_text`, \
             `fetch`, `write`, `hex`, `fields` at line 1 column 7",
        ),
    ] {
        let message = message.to_owned();
        assert_eq!(
            parse(command),
            Err(Refused {
                asked: asked(None),
                message
            }),
            "{command}"
        );
    }
}

#[test]
fn wrong_bytes_are_named_and_the_id_is_repeated() {
    for command in [
        r#"{"id": "x", "send": "41 4G"}"#,
        r#"{"id": "x", "write": "oven", "hex": "4G"}"#,
    ] {
        let refused = Refused {
            asked: asked(Some(json!("x"))),
            message: "`4G` is not made of hexadecimal bytes".to_owned(),
        };
        assert_eq!(parse(command), Err(refused), "{command}");
    }
}

#[test]
fn the_longest_telegram_fits_and_a_longer_command_is_not_read() {
    let longest = "10 ".repeat(proto3964r::tokio::Link::MAX_TELEGRAM);
    let command = format!("{{\"id\": 1, \"send\": \"{longest}\"}}");
    assert!(command.len() <= MAX_COMMAND);
    let action = Action::Send(vec![0x10; proto3964r::tokio::Link::MAX_TELEGRAM]);
    assert_eq!(parse(&command).unwrap().action, action);

    let spaces = |len| format!("{command}{}", " ".repeat(len - command.len()));
    assert!(parse(&spaces(MAX_COMMAND)).is_ok());
    let refused = Refused {
        asked: asked(None),
        message: "a command of 16385 bytes, at most 16384".to_owned(),
    };
    assert_eq!(parse(&spaces(MAX_COMMAND + 1)), Err(refused));
}

#[test]
fn outcomes_have_what_there_is() {
    let outcome = |id, error: Option<&'static str>| Outcome {
        event: "outcome",
        line: "scale",
        time: "t".to_owned(),
        id,
        ok: error.is_none(),
        error,
    };
    let id = asked(Some(json!([1]))).id.unwrap();
    assert_eq!(
        serde_json::to_value(outcome(Some(&id), Some("lost"))).unwrap(),
        json!({ "event": "outcome", "line": "scale", "time": "t", "id": [1], "ok": false, "error": "lost" })
    );
    assert_eq!(
        serde_json::to_value(outcome(None, None)).unwrap(),
        json!({ "event": "outcome", "line": "scale", "time": "t", "ok": true })
    );
}

#[test]
fn an_id_comes_back_as_it_was() {
    let id = "123456789012345678901234567890";
    for command in [
        format!("{{\"id\": {id}, \"send\": \"41\"}}"),
        // A key that nobody knows, and one that is missing.
        format!("{{\"id\": {id}, \"sned\": \"41\"}}"),
        format!("{{\"id\": {id}}}"),
    ] {
        let asked = match parse(&command) {
            Ok(job) => job.asked,
            Err(refused) => refused.asked,
        };
        assert_eq!(serde_json::to_string(&asked.id).unwrap(), id, "{command}");
    }
}

#[test]
fn nothing_to_write_is_no_success() {
    let refused = parse(r#"{"write": "oven", "fields": {}}"#).unwrap_err();
    assert_eq!(refused.message, "`fields` is empty");
}
