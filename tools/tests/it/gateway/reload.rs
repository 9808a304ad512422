//! SIGHUP: lines that have changed are opened anew, the others go on.

use serde_json::Value;
use tokio::{
    io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader, Lines},
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

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const DLE: u8 = 0x10;

/// What comes next, but for other characters before it.
async fn awaits(partner: &mut TcpStream, wanted: u8) {
    while timeout(PATIENCE, partner.read_u8()).await.unwrap().unwrap() != wanted {}
}

/// A partner with a higher priority sends a telegram and has its acknowledgement.
async fn sends(partner: &mut TcpStream, telegram: u8) {
    partner.write_u8(STX).await.unwrap();
    awaits(partner, DLE).await;
    let block = [telegram, DLE, ETX, telegram ^ DLE ^ ETX];
    partner.write_all(&block).await.unwrap();
    let answer = timeout(PATIENCE, partner.read_u8()).await.unwrap();
    assert_eq!(answer.unwrap(), DLE);
}

/// The partner's telegrams were refused while the command was under way, and the second of them kept
/// the outcome back: the line was never opened anew.
#[tokio::test(flavor = "multi_thread")]
async fn a_command_under_way_ends_while_the_partner_sends() {
    let partner = Partner::new().await;
    let [tcp, nobody] = free_ports();
    let config = format!(
        "name = \"hall\"\nstop_s = 1\n[tcp]\nlisten = \"127.0.0.1:{tcp}\"\n\
         [mqtt]\nbroker = \"mqtt://127.0.0.1:{nobody}\"\n{}",
        line("scale", partner.port)
    );
    let gateway = Gateway::start(&config);
    let mut scale = partner.stream().await;
    let mut client = Client::new(tcp).await;
    client
        .command(r#"{"line": "scale", "command": {"id": 7, "send": "41"}}"#)
        .await;
    awaits(&mut scale, STX).await;
    gateway.reload(&format!("{config}silent_after_s = 9\n"));
    gateway.logs("read again: 1 lines have changed");
    for telegram in *b"ABC" {
        sends(&mut scale, telegram).await;
    }
    awaits(&mut scale, STX).await;
    scale.write_u8(DLE).await.unwrap();
    awaits(&mut scale, ETX).await;
    scale.read_u8().await.unwrap();
    scale.write_u8(DLE).await.unwrap();
    let outcome = client.next("outcome").await;
    assert_eq!((&outcome["id"], &outcome["ok"]), (&7.into(), &true.into()));
    partner.stream().await;
    gateway.ends();
}
