//! `stream send SOCKET RECORD [BATCH]` plans a line, sends it over the board's serial port while it
//! plays, and records what was played; before that batch it is late.
//! `stream check RECORD TRACE` compares the edges of the board with the record and with the line.

mod check;
mod plan;
mod port;

use std::collections::VecDeque;
use std::error::Error;
use std::io::Read;
use std::time::Duration;
use std::{env, fs};

use cortex_m_firmware::arm_line::{JOINT, ROWS, path, quantiser};
use cortex_m_firmware::stream::{self, Event, Head, MAX_BATCH, REPORT, Report, WINDOW, encode};
use path_timing::{FeedCeiling, Knot, Table};
use plan::Plan;
use port::Socket;
use proto3964r::blocking::Driver;
use proto3964r::{Event as LineEvent, Priority};

/// Rows of a batch: some 90 ms.
const BATCH_ROWS: usize = 8;
/// The board says something at the end of each batch; its processor may be slow.
const PATIENCE: Duration = Duration::from_secs(120);

type Result<T> = std::result::Result<T, Box<dyn Error>>;

pub fn main() -> Result<()> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["send", socket, record] => send(socket, record, None),
        ["send", socket, record, batch] => send(socket, record, Some(batch.parse()?)),
        ["check", record, trace] => {
            let summary = check::check(&fs::read(record)?, &fs::read_to_string(trace)?)?;
            println!("{summary}");
            Ok(())
        }
        _ => Err("stream send SOCKET RECORD [BATCH], or stream check RECORD TRACE".into()),
    }
}

/// A batch that the board has, as far as it knows of it.
struct Sent<'a> {
    number: u16,
    is_last: bool,
    bytes: Vec<u8>,
    /// At rest after its tail.
    rest: Plan<'a>,
}

struct Sender<'a> {
    plan: Plan<'a>,
    next: u16,
    from_rest: bool,
    is_ended: bool,
    window: VecDeque<Sent<'a>>,
    record: Vec<u8>,
}

impl<'a> Sender<'a> {
    /// The next rows, and the tail that brings the machine to rest from there.
    fn batch(&mut self) -> Result<&[u8]> {
        let begin = self.plan.end_ticks();
        let steps = self.plan.rows(BATCH_ROWS)?;
        let head = Head {
            number: self.next,
            from_rest: self.from_rest,
            is_last: self.plan.is_finished(),
            ticks: [begin, self.plan.end_ticks()],
        };
        let mut rest = self.plan.clone();
        let tail = rest.stop()?;
        let parts = [&steps[0][..], &steps[1], &tail[0], &tail[1]];
        let bytes = encode(head, &parts, &mut [0; MAX_BATCH]).to_vec();
        (self.next, self.from_rest, self.is_ended) = (self.next + 1, false, head.is_last);
        self.window.push_back(Sent {
            number: head.number,
            is_last: head.is_last,
            bytes,
            rest,
        });
        Ok(&self.window.back().expect("just pushed").bytes)
    }

    /// Takes a report; says whether all is over.
    fn take(&mut self, report: Report) -> Result<bool> {
        let sent = self.window.pop_front().ok_or("a report of no batch")?;
        if sent.number != report.number {
            return Err(format!("a report of batch {}, not {}", report.number, sent.number).into());
        }
        let rests = report.event == Event::Rests;
        self.record.push(u8::from(rests));
        self.record
            .extend(u32::try_from(sent.bytes.len())?.to_le_bytes());
        self.record.extend(&sent.bytes);
        if rests && !sent.is_last {
            // What has been sent since is dropped there.
            eprintln!(
                "batch {}: late; at rest at steps {:?}",
                sent.number, report.steps
            );
            self.window.clear();
            self.plan = sent.rest;
            self.plan.resume()?;
            (self.next, self.from_rest, self.is_ended) = (sent.number + 1, true, false);
        }
        Ok(rests && sent.is_last)
    }
}

fn send(socket: &str, record: &str, late: Option<u16>) -> Result<()> {
    let path = path();
    let mut knots = [Knot::default(); ROWS + 1];
    let mut ceilings = [FeedCeiling::default(); ROWS + 1];
    let table = Table::plan([path], [JOINT; 2], |_| ROWS as u32, &mut knots)?;
    let playback = table.playback(1.0, &mut ceilings)?;
    let mut sender = Sender {
        plan: Plan::new(playback, quantiser(&path)),
        next: 0,
        from_rest: true,
        is_ended: false,
        window: VecDeque::new(),
        record: Vec::new(),
    };

    let mut socket = Socket::connect(socket)?;
    // The NAK that the board begins with: later it would be the answer to an STX.
    socket.read_exact(&mut [0])?;
    let config = stream::line(Priority::High);
    let mut line = Driver::<_, REPORT, MAX_BATCH>::new(socket, config)?;
    loop {
        // So late that the board has come to rest.
        let is_late = late == Some(sender.next) && !sender.from_rest;
        if !line.is_busy() && !sender.is_ended && !is_late && sender.window.len() < WINDOW {
            line.submit(sender.batch()?)?;
        }
        match line.wait(PATIENCE)?.ok_or("the board says nothing")? {
            LineEvent::Received(telegram) => {
                let report = Report::of(telegram).ok_or("no report")?;
                if sender.take(report)? {
                    break;
                }
            }
            LineEvent::Failed(failure) => return Err(format!("{failure:?}").into()),
            _ => {}
        }
    }
    fs::write(record, &sender.record)?;
    // The board may say what it has done.
    while line.is_busy() {
        line.wait(PATIENCE)?;
    }
    line.submit(&[])?;
    while line.is_busy() {
        line.wait(PATIENCE)?;
    }
    Ok(())
}
