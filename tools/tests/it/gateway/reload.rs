//! SIGHUP: lines that have changed are opened anew, the others go on.

use serde_json::Value;
use tokio::{
    io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader, Lines},
    net::{
        TcpStream,
        tcp::{OwnedReadHalf, OwnedWriteHalf},
    },
    time::timeout,
};

use super::{
    listeners::free_ports,
    partner::Partner,
    process::{Gateway, PATIENCE, line},
};

/// A client of the gateway over TCP.
struct Client {
    events: Lines<BufReader<OwnedReadHalf>>,
    commands: OwnedWriteHalf,
}

impl Client {
    async fn new(port: u16) -> Self {
        let stream = TcpStream::connect(("127.0.0.1", port)).await.unwrap();
        let (events, commands) = stream.into_split();
        Self {
            events: BufReader::new(events).lines(),
            commands,
        }
    }

    /// The next event of this kind; others are passed over.
    async fn next(&mut self, kind: &str) -> Value {
        loop {
            let line = timeout(PATIENCE, self.events.next_line()).await;
            let line = line.expect("an event").unwrap().unwrap();
            let event: Value = serde_json::from_str(&line).unwrap();
            if event["event"] == kind {
                return event;
            }
        }
    }

    async fn command(&mut self, command: &str) {
        let line = format!("{command}\n");
        self.commands.write_all(line.as_bytes()).await.unwrap();
    }
}

const LETTER: &str = "[[line.telegram]]\nname = \"letter\"\nlength = 1\n";

#[tokio::test(flavor = "multi_thread")]
async fn what_can_change_does_and_the_rest_is_named() {
    let (scale, oven, other) = (
        Partner::new().await,
        Partner::new().await,
        Partner::new().await,
    );
    let [tcp] = free_ports();
    let config = format!("name = \"hall\"\n[tcp]\nlisten = \"127.0.0.1:{tcp}\"\n");
    let (scale_line, oven_line) = (line("scale", scale.port), line("oven", oven.port));
    let gateway = Gateway::start(&format!("{config}{scale_line}{oven_line}"));
    let (first, steady) = (scale.link().await, oven.link().await);
    gateway.logs("2 lines");
    let mut client = Client::new(tcp).await;
    // Until the gateway has taken the client, events pass it by.
    client.command(r#"{"line": "none", "command": {}}"#).await;
    gateway.logs("no such line");
    first.send(b"A").await.unwrap();
    let event = client.next("telegram").await;
    assert_eq!((&event["name"], &event["seq"]), (&Value::Null, &1.into()));

    let added = line("press", other.port);
    gateway.reload(&format!(
        "stop_s = 9\n{config}{scale_line}read_only = true\ncommands = 5\n{LETTER}{oven_line}{added}"
    ));
    let second = scale.link().await;
    assert!(first.receive().await.is_err(), "the line was closed");
    second.send(b"B").await.unwrap();
    let event = client.next("telegram").await;
    assert_eq!(
        (&event["name"], &event["seq"]),
        (&"letter".into(), &2.into())
    );
    client
        .command(r#"{"line": "scale", "command": {"send": "41"}}"#)
        .await;
    assert_eq!(
        client.next("outcome").await["error"],
        "the line is read-only"
    );
    steady.send(b"C").await.unwrap();
    assert_eq!(client.next("telegram").await["line"], "oven");
    for what in [
        "`stop_s` has changed",
        "press: is a new line",
        "scale: `commands` has changed",
    ] {
        gateway.logs(&format!("{what}: counts from the next start"));
    }
    gateway.logs("read again: 1 lines have changed");

    // What is wrong changes nothing.
    gateway.reload(&format!("{config}{scale_line}priority = 5\n"));
    gateway.logs("not read again, everything stays as it was: ");
    second.send(b"D").await.unwrap();
    assert_eq!(client.next("telegram").await["name"], "letter");
    // A line that is gone from the file goes on.
    gateway.reload(&format!("{config}{scale_line}"));
    gateway.logs("oven: is no line any more");
    steady.send(b"E").await.unwrap();
    assert_eq!(client.next("telegram").await["line"], "oven");
    gateway.ends();
}
