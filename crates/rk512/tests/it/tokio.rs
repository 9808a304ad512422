//! The client over streams of tokio, against a partner with a data block.

use core::time::Duration;
use std::io::ErrorKind;

use proto3964r::{
    Cause, Config as LineConfig, Line, Priority,
    tokio::{Link, SendError},
};
use rk512::{
    Area, CallError, Command, Config, DataBlock, DataSource, JobError, Memory, ReactionError,
    Server,
    tokio::{Client, connect},
};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, duplex},
    net::TcpListener,
    time::timeout,
};

const LOW: LineConfig = LineConfig::siemens_3964r(Priority::Low, Line::Instant);
const HIGH: LineConfig = LineConfig::siemens_3964r(Priority::High, Line::Instant);

/// A PLC with data block 10 of 255 words, until its connection ends.
async fn plc(line: Link) {
    let mut db10 = [0; 510];
    let mut memory = Memory::new([DataBlock::db(10, &mut db10)]);
    let mut server = Server::new(Config::DEFAULT);
    let now = Duration::ZERO;
    while let Ok(command) = line.receive().await {
        server.handle_block(&command, &mut memory);
        while let Some(reaction) = server.poll_transmit() {
            match line.send(&reaction).await {
                Ok(()) => server.handle_delivered(now),
                Err(SendError::Lost(_)) => return,
                Err(_) => server.handle_failed(&mut memory),
            }
        }
    }
}

fn client(stream: impl AsyncRead + AsyncWrite + Send + 'static) -> Client {
    Client::new(stream, LOW, Config::DEFAULT)
}

/// A client and its PLC on a line without time.
fn pair() -> Client {
    let (here, there) = duplex(1024);
    tokio::spawn(plc(Link::new(there, HIGH)));
    client(here)
}

/// Neither a multiple of a telegram's data nor free of control characters.
fn data(len: usize) -> Vec<u8> {
    let control = [0x02, 0x03, 0x10, 0x15, 0xFF, 0x41, 0x00];
    control.iter().copied().cycle().take(len).collect()
}

/// One direction of a serial server at 9600 bit/s, 11 bits a character.
async fn pace(mut from: impl AsyncRead + Unpin, mut to: impl AsyncWrite + Unpin) {
    while let Ok(byte) = from.read_u8().await {
        tokio::time::sleep(Duration::from_micros(1146)).await;
        if to.write_u8(byte).await.is_err() {
            return;
        }
    }
}

#[tokio::test]
async fn what_was_sent_over_tcp_is_fetched() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("tcp://{}", listener.local_addr().unwrap());
    let (client, accepted) = tokio::join!(connect(&address), listener.accept());
    let (server, port) = (accepted.unwrap().0, duplex(1024));
    tokio::spawn(plc(Link::new(port.1, HIGH)));
    let (from_client, to_client) = server.into_split();
    let (from_plc, to_plc) = tokio::io::split(port.0);
    tokio::spawn(pace(from_client, to_plc));
    tokio::spawn(pace(from_plc, to_client));
    let client = client.unwrap();
    client.send(Area::db(10, 4), b"12.5 kg ").await.unwrap();
    let fetched = client.fetch(Area::db(10, 4), 4).await.unwrap();
    assert_eq!(fetched, b"12.5 kg ");
}

#[tokio::test(start_paused = true)]
async fn jobs_of_several_telegrams_at_once() {
    let client = &pair();
    let send = |word, len| async move { client.send(Area::db(10, word), &data(len)).await };
    let (first, second) = tokio::join!(send(0, 300), send(150, 200));
    assert!(first.is_ok() && second.is_ok());
    assert_eq!(client.fetch(Area::db(10, 0), 150).await.unwrap(), data(300));
    assert_eq!(
        client.fetch(Area::db(10, 150), 100).await.unwrap(),
        data(200)
    );
}

#[tokio::test(start_paused = true)]
async fn what_the_plc_refuses_is_told_with_its_number() {
    let client = pair();
    let error = client.fetch(Area::db(11, 0), 1).await.unwrap_err();
    let refused = JobError::Refused(ReactionError::NoSuchBlock);
    assert!(matches!(error, CallError::Failed(error) if error == refused));
    assert!(client.fetch(Area::db(10, 0), 1).await.is_ok());
}

#[tokio::test(start_paused = true)]
async fn jobs_that_cannot_be_are_refused() {
    let client = pair();
    let odd = client.send(Area::db(10, 0), &[1, 2, 3]).await.unwrap_err();
    assert!(matches!(odd, CallError::Words { len: 3 }), "{odd}");
    let none = client.send(Area::db(10, 0), &[]).await.unwrap_err();
    assert!(matches!(none, CallError::Request(_)), "{none}");
    let long = client.fetch(Area::db(10, 0), 2049).await.unwrap_err();
    assert!(matches!(long, CallError::Refused(_)), "{long}");
}

#[tokio::test(start_paused = true)]
async fn a_dead_line_and_a_silent_plc_are_told_apart() {
    let (here, _there) = duplex(1024);
    let error = client(here).fetch(Area::db(10, 0), 1).await.unwrap_err();
    assert!(
        matches!(error, CallError::NotDelivered(failure) if failure.cause == Cause::Timeout),
        "{error}"
    );

    let (here, there) = duplex(1024);
    let _silent = Link::new(there, HIGH);
    let error = client(here).fetch(Area::db(10, 0), 1).await.unwrap_err();
    let time = Config::DEFAULT.reaction_time;
    assert!(matches!(error, CallError::Failed(JobError::NoReaction(after)) if after == time));
}

#[tokio::test(start_paused = true)]
async fn a_dropped_job_is_given_up_and_its_late_reaction_is_not_the_next_ones() {
    let (here, there) = duplex(1024);
    let line = Link::new(there, HIGH);
    let client = client(here);
    let second = Duration::from_secs(1);
    let dropped = timeout(second, client.fetch(Area::db(10, 0), 1)).await;
    assert!(dropped.is_err());
    assert_eq!(line.receive().await.unwrap()[2], b'E');
    let late = [0, 0, 0, 0, 0xAA, 0xAA];
    let (sent, fetched, ()) =
        tokio::join!(line.send(&late), client.fetch(Area::db(10, 0), 1), async {
            line.receive().await.unwrap();
            line.send(&[0, 0, 0, 0, 0x12, 0x34]).await.unwrap();
        });
    sent.unwrap();
    assert_eq!(fetched.unwrap(), [0x12, 0x34]);
}

#[tokio::test(start_paused = true)]
async fn what_the_partner_asks_for_is_refused() {
    let (here, there) = duplex(1024);
    let (line, _client) = (Link::new(there, HIGH), client(here));
    let fetch = Command::fetch(Area::flags(0), 1).unwrap();
    line.send(&fetch.telegram(&[]).unwrap()).await.unwrap();
    let refused = ReactionError::RequestType.code();
    assert_eq!(line.receive().await.unwrap(), [0, 0, 0, refused]);
}

#[tokio::test(start_paused = true)]
async fn a_lost_connection_is_told_to_every_job() {
    let (here, there) = duplex(1024);
    let client = client(here);
    drop(there);
    for _ in 0..2 {
        let error = client.fetch(Area::db(10, 0), 1).await.unwrap_err();
        let CallError::Lost(lost) = error else {
            panic!("{error}");
        };
        assert!(matches!(
            lost.kind(),
            ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe
        ));
    }
}

/// One direction of a line on which every 499th byte loses a bit.
async fn damage(mut from: impl AsyncRead + Unpin, mut to: impl AsyncWrite + Unpin) {
    let mut count = 0;
    while let Ok(byte) = from.read_u8().await {
        count += 1;
        let damaged = if count % 499 == 0 { byte ^ 4 } else { byte };
        if to.write_u8(damaged).await.is_err() {
            return;
        }
    }
}

#[tokio::test(start_paused = true)]
async fn noise_costs_repeats_and_what_is_fetched_is_what_was_sent() {
    let ((here, left), (right, there)) = (duplex(1024), duplex(1024));
    let (left_reader, left_writer) = tokio::io::split(left);
    let (right_reader, right_writer) = tokio::io::split(right);
    tokio::spawn(damage(left_reader, right_writer));
    tokio::spawn(damage(right_reader, left_writer));
    tokio::spawn(plc(Link::new(there, HIGH)));
    // A link takes no telegram back: the pause outlasts the repeat of a reaction that had arrived.
    let pause = Duration::from_secs(6);
    let config = Config {
        quiet: pause,
        resync: pause,
        ..Config::DEFAULT
    };
    let client = Client::new(here, LOW, config);
    for len in (2..400).step_by(22) {
        let (words, data) = (u16::try_from(len / 2).unwrap(), data(len));
        let mut failed = 0;
        // A job may fail on a damaged acknowledgement, and is repeated then.
        let fetched = loop {
            let sent = client.send(Area::db(10, 0), &data).await;
            if let (Ok(()), Ok(fetched)) = (sent, client.fetch(Area::db(10, 0), words).await) {
                break fetched;
            }
            failed += 1;
            assert!(failed < 5, "{len} bytes");
        };
        assert_eq!(fetched, data);
    }
}

/// Data block 10 of the side that also asks, each job of which waits for its user.
struct Held(Vec<u8>);

impl Held {
    fn memory(&mut self) -> Memory<'_, 1> {
        Memory::new([DataBlock::db(10, &mut self.0)])
    }
}

impl DataSource for Held {
    fn size(&mut self, command: &Command) -> Result<usize, ReactionError> {
        self.memory().size(command)
    }

    fn read(&mut self, command: &Command, at: usize, data: &mut [u8]) -> Result<(), ReactionError> {
        self.memory().read(command, at, data)
    }

    fn write(&mut self, command: &Command, at: usize, data: &[u8]) -> Result<(), ReactionError> {
        self.memory().write(command, at, data)
    }

    fn holds(&self, command: &Command) -> bool {
        command.is_send()
    }
}

#[tokio::test]
async fn both_sides_ask_and_serve_and_a_reaction_waits_for_the_user() {
    let (here, there) = duplex(1024);
    let side = |stream, line| {
        Client::with_source(stream, line, Config::DEFAULT, Held(vec![0; 20]), |_| {})
    };
    let (low, high) = (side(here, LOW), side(there, HIGH));
    let (area, data) = (Area::db(10, 2), *b"abcd");
    let answering = async {
        for error in [Some(ReactionError::Stopped), None] {
            let job = low.held().await.unwrap();
            assert_eq!(job.command(), Command::send(area, 2).unwrap());
            // Its own job meanwhile.
            assert_eq!(low.fetch(Area::db(10, 0), 1).await.unwrap(), [0, 0]);
            match error {
                Some(error) => assert!(!job.refuse(error).await),
                None => assert!(job.accept().await),
            }
        }
        drop(low.held().await.unwrap());
    };
    let asking = async {
        let refusal = |result: Result<(), CallError>| match result {
            Err(CallError::Failed(JobError::Refused(error))) => Some(error),
            other => panic!("{other:?}"),
        };
        let refused = refusal(high.send(area, &data).await);
        assert_eq!(refused, Some(ReactionError::Stopped));
        high.send(area, &data).await.unwrap();
        let refused = refusal(high.send(area, &data).await);
        assert_eq!(refused, Some(ReactionError::JobFailed));
        assert_eq!(high.fetch(area, 2).await.unwrap(), data);
    };
    timeout(Duration::from_secs(60), async {
        tokio::join!(answering, asking)
    })
    .await
    .unwrap();
}
