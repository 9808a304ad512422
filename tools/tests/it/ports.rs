//! Stations of both sides over every kind of port.
//!
//! Without pyserial one test says so on standard error and passes; with
//! `POSE2PULSE_REQUIRE_PYSERIAL=1` it fails.

use core::{future::Future, time::Duration};
use std::{
    env, fs,
    io::{self, BufRead as _, BufReader},
    net,
    path::Path,
    process::{Command, Stdio},
};

use line3964r::{Address, Port};
use proto3964r::{Config, Line, Priority, tokio::Link};
use tempfile::TempDir;
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, DuplexStream, duplex},
    net::{TcpListener, TcpStream},
    task::spawn_blocking,
    time::timeout,
};

const LOW: Config = Config::siemens_3964r(Priority::Low, Line::Instant);
const HIGH: Config = Config::siemens_3964r(Priority::High, Line::Instant);
/// Telegrams in each direction.
const COUNT: u8 = 100;
/// Above what all of them take on a busy computer.
const PATIENCE: Duration = Duration::from_secs(60);

/// Control characters, those that TELNET and terminals mark, and lengths from 1 to 60.
fn telegram(number: u8) -> Vec<u8> {
    let control = [0x02, 0x03, 0x10, 0xFF, 0x00, 0x15, 0x11, 0x0D, 0x0A];
    let rest = control.iter().cycle().take(usize::from(number % 60));
    core::iter::once(number).chain(rest.copied()).collect()
}

async fn send_all(link: &Link) {
    for number in 0..COUNT {
        link.send(&telegram(number)).await.unwrap();
    }
}

/// Receives every telegram in their order; a lost acknowledgement makes a duplicate.
async fn receive_all(link: &Link) {
    let mut last = None;
    for number in 0..COUNT {
        let wanted = telegram(number);
        let mut received = link.receive().await.unwrap();
        while Some(&received) == last.as_ref() {
            received = link.receive().await.unwrap();
        }
        assert_eq!(received, wanted);
        last = Some(received);
    }
}

/// Both stations send and receive at once.
async fn both_ways<A, B>(a: A, b: B)
where
    A: AsyncRead + AsyncWrite + Send + 'static,
    B: AsyncRead + AsyncWrite + Send + 'static,
{
    let (a, b) = (Link::new(a, LOW), Link::new(b, HIGH));
    let all = async {
        tokio::join!(send_all(&a), send_all(&b), receive_all(&a), receive_all(&b));
    };
    timeout(PATIENCE, all).await.unwrap();
}

async fn open(address: &str) -> io::Result<Port> {
    address.parse::<Address>().unwrap().open().await
}

/// Opens a port whose partner may not be there yet.
async fn open_when_there(address: &str) -> Port {
    let opened = async {
        loop {
            match open(address).await {
                Ok(port) => return port,
                Err(_) => tokio::time::sleep(Duration::from_millis(5)).await,
            }
        }
    };
    timeout(PATIENCE, opened).await.unwrap()
}

/// A port of this machine that nobody listens to.
fn free_port() -> u16 {
    let listener = net::TcpListener::bind("127.0.0.1:0").unwrap();
    listener.local_addr().unwrap().port()
}

#[tokio::test]
async fn a_pseudo_terminal_and_who_opens_it() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("line").display().to_string();
    let here = open(&format!("pty:{path}")).await.unwrap();
    let there = open(&path).await.unwrap();
    both_ways(here, there).await;
}

#[tokio::test]
async fn a_pseudo_terminal_takes_its_name_away() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("line");
    let address = format!("pty:{}", path.display());
    drop(open(&address).await.unwrap());
    assert!(fs::symlink_metadata(&path).is_err());

    // A program that was killed has left its own.
    std::os::unix::fs::symlink("/dev/pts/4711", &path).unwrap();
    drop(open(&address).await.unwrap());
    assert!(fs::symlink_metadata(&path).is_err());

    fs::write(&path, "a file of somebody").unwrap();
    let error = open(&address).await.unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read(&path).unwrap(), b"a file of somebody");
}

#[tokio::test]
async fn tcp() {
    let port = free_port();
    let (listen, connect) = (
        format!("tcp-listen://127.0.0.1:{port}"),
        format!("tcp://127.0.0.1:{port}"),
    );
    let (here, there) = tokio::join!(open(&listen), open_when_there(&connect));
    both_ways(here.unwrap(), there).await;
}

/// A bus on which everybody hears every character, its own too.
async fn bus(listener: TcpListener, partner: DuplexStream) -> ! {
    let (mut a, _) = listener.accept().await.unwrap();
    a.set_nodelay(true).unwrap();
    let mut b = partner;
    let (mut from_a, mut from_b) = ([0; 64], [0; 64]);
    loop {
        let piece = tokio::select! {
            len = a.read(&mut from_a) => &from_a[..len.unwrap()],
            len = b.read(&mut from_b) => {
                // A partner that does not hear itself.
                a.write_all(&from_b[..len.unwrap()]).await.unwrap();
                continue;
            }
        };
        a.write_all(piece).await.unwrap();
        b.write_all(piece).await.unwrap();
    }
}

/// The partner does not speak while the other does: a two-wire line bears one at a time.
#[tokio::test]
async fn own_echo_is_removed() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("tcp://{}?echo=remove", listener.local_addr().unwrap());
    let (there, other) = duplex(4096);
    let bus = tokio::spawn(bus(listener, other));
    let mut port = open(&address).await.unwrap();
    let b = Link::new(there, HIGH);
    // The NAK that it begins with.
    assert_eq!(port.read_u8().await.unwrap(), 0x15);
    let a = Link::new(port, LOW);
    for number in 0..COUNT {
        a.send(&telegram(number)).await.unwrap();
        assert_eq!(b.receive().await.unwrap(), telegram(number));
        b.send(&telegram(number)).await.unwrap();
        assert_eq!(a.receive().await.unwrap(), telegram(number));
    }
    // The last echo may not have been read yet: closing would reset the connection.
    bus.abort();
}

/// A serial server of RFC 2217 that answers every setting with `set`, and then carries characters
/// between the connection and `line`.
async fn serial_server(
    listener: TcpListener,
    mut line: DuplexStream,
    set: impl Fn(u8, &[u8]) -> Vec<u8>,
) {
    let (mut stream, _) = listener.accept().await.unwrap();
    stream.set_nodelay(true).unwrap();
    stream.write_all(&[255, 253, 44]).await.unwrap();
    let mut confirmed = 0;
    while confirmed < 6 {
        if read_byte(&mut stream).await != 255 {
            continue;
        }
        match read_byte(&mut stream).await {
            250 => confirmed += 1,
            _ => {
                read_byte(&mut stream).await;
                continue;
            }
        }
        assert_eq!(read_byte(&mut stream).await, 44);
        let command = read_byte(&mut stream).await;
        let mut value = Vec::new();
        loop {
            match read_byte(&mut stream).await {
                255 => match read_byte(&mut stream).await {
                    240 => break,
                    byte => value.push(byte),
                },
                byte => value.push(byte),
            }
        }
        let answer = [&[255, 250, 44, command + 100][..], &set(command, &value)].concat();
        let answer = [&answer[..], &[255, 240]].concat();
        if stream.write_all(&answer).await.is_err() {
            return;
        }
    }
    loop {
        tokio::select! {
            byte = stream.read_u8() => match byte {
                Ok(255) => {
                    assert_eq!(read_byte(&mut stream).await, 255);
                    line.write_u8(255).await.unwrap();
                }
                Ok(byte) => line.write_u8(byte).await.unwrap(),
                Err(_) => return,
            },
            byte = line.read_u8() => match byte {
                Ok(255) => stream.write_all(&[255, 255]).await.unwrap(),
                Ok(byte) => stream.write_u8(byte).await.unwrap(),
                Err(_) => return,
            },
        }
    }
}

async fn read_byte(stream: &mut TcpStream) -> u8 {
    stream.read_u8().await.unwrap()
}

async fn with_server<F, O>(
    settings: &str,
    set: impl Fn(u8, &[u8]) -> Vec<u8> + Send + 'static,
    run: impl FnOnce(io::Result<Port>, DuplexStream) -> F,
) -> O
where
    F: Future<Output = O>,
{
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("rfc2217://{}{settings}", listener.local_addr().unwrap());
    let (line, there) = duplex(64);
    tokio::spawn(serial_server(listener, line, set));
    run(open(&address).await, there).await
}

#[tokio::test]
async fn rfc_2217() {
    let confirm = |_, value: &[u8]| value.to_vec();
    with_server("", confirm, |port, there| async move {
        both_ways(port.unwrap(), there).await;
    })
    .await;
}

/// Debian's own, for which there is a package python3-serial.
const PYTHON: &str = "/usr/bin/python3";
/// Set to 1: a missing pyserial is a failure.
const REQUIRE: &str = "POSE2PULSE_REQUIRE_PYSERIAL";

fn has_pyserial() -> bool {
    let import = Command::new(PYTHON).args(["-c", "import serial"]).output();
    let found = import.is_ok_and(|output| output.status.success());
    assert!(found || env::var_os(REQUIRE).is_none(), "no pyserial");
    found
}

/// A server that others have written. A pseudo-terminal knows no parity.
#[tokio::test]
async fn rfc_2217_by_pyserial() {
    if !has_pyserial() {
        eprintln!("skipped: {PYTHON} has no pyserial");
        return;
    }
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("line").display().to_string();
    let line = open(&format!("pty:{path}")).await.unwrap();
    let mut server = Command::new(PYTHON)
        .arg(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/serial_server.py"
        ))
        .arg(&path)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut printed = BufReader::new(server.stdout.take().unwrap()).lines();
    let port = printed.next().unwrap().unwrap();
    let address = format!("rfc2217://127.0.0.1:{port}?baud=19200&parity=none&stop=2");
    both_ways(open(&address).await.unwrap(), line).await;
    // The task of a station closes its port; it must not be kept from that.
    let ended = spawn_blocking(move || (printed.next().unwrap().unwrap(), server.wait().unwrap()));
    let (settings, status) = timeout(PATIENCE, ended).await.unwrap().unwrap();
    assert_eq!(settings, "19200 8 N 2");
    assert!(status.success());
}

#[tokio::test]
async fn a_serial_server_that_does_otherwise_is_refused() {
    let slow = |command, value: &[u8]| match command {
        1 => 9600_u32.to_be_bytes().to_vec(),
        _ => value.to_vec(),
    };
    let error = with_server(
        "?baud=19200",
        slow,
        |port, _| async move { port.unwrap_err() },
    )
    .await;
    assert_eq!(
        error.to_string(),
        "the server sets baud to 9600 in place of 19200"
    );
}

#[tokio::test]
async fn ports_that_are_none() {
    for (address, kind) in [
        ("/nowhere/port", io::ErrorKind::NotFound),
        ("pty:/nowhere/line", io::ErrorKind::NotFound),
        (
            "tcp-listen://192.0.2.1:4001",
            io::ErrorKind::AddrNotAvailable,
        ),
    ] {
        let error = open(address).await.unwrap_err();
        assert_eq!(error.kind(), kind, "{address}");
    }
    let address = format!("tcp://127.0.0.1:{}", free_port());
    let error = open(&address).await.unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::ConnectionRefused);
    assert!(Path::new("/dev/null").exists());
    let error = open("/dev/null").await.unwrap_err();
    assert_eq!(
        error.to_string(),
        "Inappropriate ioctl for device (os error 25)"
    );
}
