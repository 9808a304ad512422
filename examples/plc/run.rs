//! Command line, threads and report.

use core::error::Error;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;

use clap::Parser;
use proto3964r::{Config as LineConfig, Line, Priority};
use rk512::Area;
use serialport::TTYPort;

use crate::line::{Noise, Tap};
use crate::party::{BLOCK, Order, Party, QVZ_MS, Tally};

/// As many as the data blocks have room for: each begins one word further on.
const MOST_ROUNDS: i64 = 60;
/// Longer than any block on the line, so that none is hit twice: two errors can cancel in the BCC.
const LEAST_SPACING: u64 = 280;

/// Two RK512 stations on pseudo-terminals that write and read each other's data blocks over
/// 3964R, through a line that damages bytes.
#[derive(Parser)]
pub(crate) struct Options {
    /// Folder for line.log and report.json.
    #[arg(long, value_name = "DIR", default_value = "target/plc")]
    out: PathBuf,
    /// Data blocks that each side writes and reads back.
    #[arg(long, default_value_t = 40, value_parser = clap::value_parser!(u8).range(1..=MOST_ROUNDS))]
    rounds: u8,
    /// One byte of every N to 2 N is damaged; 0 for a clean line.
    #[arg(long, default_value_t = 300, value_parser = spacing)]
    spacing: u64,
    /// Which bytes are damaged, and how.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn spacing(text: &str) -> Result<u64, String> {
    let spacing = text.parse().map_err(|error| format!("{error}"))?;
    if (1..LEAST_SPACING).contains(&spacing) {
        return Err(format!(
            "must be 0 or at least {LEAST_SPACING}, so that no block is hit twice"
        ));
    }
    Ok(spacing)
}

/// Data full of the control characters of 3964R, for DB 1 and DX 2 in turn.
fn orders(rounds: u8, salt: u8) -> Vec<Order> {
    let order = |round: u8| {
        let area = if round.is_multiple_of(2) {
            Area::db(1, round)
        } else {
            Area::dx(2, round)
        };
        let alphabet = [0x02, 0x03, 0x10, 0x10, 0x15, salt, round, 0x00];
        let len = 2 * (40 + usize::from(round) * 31 % 150);
        let data = alphabet.iter().cycle().skip(round.into()).step_by(3);
        Order {
            area,
            data: data.take(len).copied().collect(),
        }
    };
    (0..rounds).map(order).collect()
}

/// What the partner's memory must hold in the end.
fn expected(orders: &[Order]) -> [[u8; BLOCK]; 2] {
    let mut blocks = [[0; BLOCK]; 2];
    for Order { area, data } in orders {
        let [db, dx] = &mut blocks;
        let block = if area.number() == 1 { db } else { dx };
        let place = block.iter_mut().skip(2 * usize::from(area.start()));
        for (to, &from) in place.zip(data) {
            *to = from;
        }
    }
    blocks
}

pub(crate) fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let log = options.out.join("line.log");
    let created = fs::create_dir_all(&options.out).and_then(|()| File::create(&log));
    let tap = Tap::new(created.map_err(|error| format!("{}: {error}", log.display()))?);
    let line = |priority| LineConfig {
        qvz_ms: QVZ_MS,
        zvz_ms: QVZ_MS / 2,
        bwz_ms: 4 * QVZ_MS,
        ..LineConfig::siemens_3964r(priority, Line::Instant)
    };
    let side = |priority, salt| {
        let (master, slave) = TTYPort::pair()?;
        let orders = orders(options.rounds, salt);
        let party = Party::new(slave, line(priority), orders, tap.start);
        Ok::<_, Box<dyn Error>>((master, party.map_err(|e| e.to_string())?))
    };
    let (pc_line, mut pc) = side(Priority::High, 0xA1)?;
    let (plc_line, mut plc) = side(Priority::Low, 0xB2)?;
    let (from_pc, from_plc) = (pc_line.try_clone_native()?, plc_line.try_clone_native()?);
    let noise = |salt| Noise::new(options.seed.wrapping_mul(salt), options.spacing);

    let working = AtomicUsize::new(2);
    let (mut pc_memory, mut plc_memory) = ([[0; BLOCK]; 2], [[0; BLOCK]; 2]);
    let (tallies, lines) = thread::scope(|scope| {
        let forth = scope.spawn(|| tap.carry(from_pc, plc_line, '>', noise(0x9E37_79B9)));
        let back = scope.spawn(|| tap.carry(from_plc, pc_line, '<', noise(0x85EB_CA6B)));
        let pc_work = scope.spawn(|| stopping(&working, || pc.run(&mut pc_memory, &working)));
        let plc_work = scope.spawn(|| stopping(&working, || plc.run(&mut plc_memory, &working)));
        let tallies = [pc_work.join(), plc_work.join()];
        tap.closed.store(true, Ordering::Relaxed);
        (tallies, [forth.join(), back.join()])
    });
    for line in lines {
        line.map_err(|_| "the line's thread panicked")??;
    }
    let [pc, plc] = tallies.map(|tally| tally.map_err(|_| "a side's thread panicked"));
    let pc = pc?.map_err(|error| error.to_string())?;
    let plc = plc?.map_err(|error| error.to_string())?;
    let whole = plc_memory == expected(&orders(options.rounds, 0xA1))
        && pc_memory == expected(&orders(options.rounds, 0xB2));
    report(&options.out, &tap, &[("pc", pc), ("plc", plc)], whole)
}

/// Ends the other side's work too when this one fails.
fn stopping<T, E>(working: &AtomicUsize, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    work().inspect_err(|_| working.store(0, Ordering::Relaxed))
}

fn report(
    out: &Path,
    tap: &Tap,
    tallies: &[(&str, Tally)],
    whole: bool,
) -> Result<(), Box<dyn Error>> {
    tap.log
        .lock()
        .map_err(|_| "the log's owner panicked")?
        .flush()?;
    let seconds = tap.start.elapsed().as_secs_f64();
    let bytes = tap.bytes.load(Ordering::Relaxed);
    let damaged = tap.damaged.load(Ordering::Relaxed);
    let mut json = format!(
        "{{\n  \"seconds\": {seconds:.3},\n  \"line_bytes\": {bytes},\n  \"damaged_bytes\": {damaged},\n"
    );
    println!("line: {bytes} bytes, {damaged} damaged, {seconds:.1} s");
    for (name, tally) in tallies {
        let Tally {
            done,
            failed,
            different,
            rejected,
            bytes,
        } = tally;
        println!(
            "{name}: {done} data blocks written and read back ({bytes} bytes), {different} different, \
             {failed} jobs repeated, {rejected} blocks rejected"
        );
        json += &format!(
            "  \"{name}\": {{ \"done\": {done}, \"bytes\": {bytes}, \"different\": {different}, \
             \"jobs_repeated\": {failed}, \"blocks_rejected\": {rejected} }},\n"
        );
    }
    json += &format!("  \"memories_as_written\": {whole}\n}}\n");
    fs::write(out.join("report.json"), json)?;
    println!("{}", out.join("report.json").display());
    if !whole || tallies.iter().any(|(_, tally)| tally.different > 0) {
        return Err("data were lost".into());
    }
    println!("nothing was lost");
    Ok(())
}
