//! Two RK512 stations on pseudo-terminals: a PC and a PLC that write and read each other's data
//! blocks at the same time, over 3964R, through a line that damages bytes: the command line of
//! `machines/plc`.
//!
//! Of every `N` to `2 N` bytes of the line one is flipped, lost or doubled (`--spacing`). Each side
//! writes a data block, reads it back, compares, and repeats a job that failed. Writes `line.log`
//! (what each side received: time in s, `>` from the PC, `<` from the PLC, bytes) and
//! `report.json`.
//!
//! `cargo run --release --example plc -- [--rounds N] [--spacing N] [--seed N] [--out DIR]`

use core::sync::atomic::{AtomicUsize, Ordering};
use core::time::Duration;
use std::path::PathBuf;
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use anyhow::{Result, anyhow};
use clap::{Parser, value_parser};
use command_line::{Artefacts, Cable, print_summary};
use plc::{DamagingLine, MAX_TELEGRAM, Report, Role, Side, Spacing};
use proto3964r::{Line, serialport::Driver};

/// How soon it is noticed that a reaction time ran out.
const TURN: Duration = Duration::from_millis(1);

/// Two RK512 stations on pseudo-terminals that write and read each other's data blocks over
/// 3964R, through a line that damages bytes.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// Folder for line.log and report.json.
    #[arg(long, value_name = "DIR", default_value = "target/plc")]
    out: PathBuf,
    /// Data blocks that each side writes and reads back.
    #[arg(long, default_value_t = 40, value_parser = value_parser!(u8).range(1..=Side::MAX_ROUNDS.into()))]
    rounds: u8,
    /// One byte of every N to 2 N is damaged; 0 for a clean line.
    #[arg(long, default_value = "300")]
    spacing: Spacing,
    /// Which bytes are damaged, and how.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    command_line::run(run)
}

fn run(args: &Args) -> Result<ExitCode> {
    let mut artefacts = Artefacts::new(&args.out)?;
    let log = artefacts.create("line.log")?;
    let mut line = DamagingLine::new(log, args.spacing, args.seed);
    let (cable, [pc_port, plc_port]) = Cable::open()?;
    let config = |role: Role| role.line_config(Line::Instant);
    // These outlive the cable, where a closed port is an error.
    let pc_line = &mut Driver::new(pc_port, config(Role::Pc))?;
    let plc_line = &mut Driver::new(plc_port, config(Role::Plc))?;
    let pc = Side::new(Role::Pc, args.rounds)?;
    let plc = Side::new(Role::Plc, args.rounds)?;
    let done = AtomicUsize::new(0);
    let start = Instant::now();
    let pass = |is_first, bytes: &[u8]| {
        let from = if is_first { Role::Pc } else { Role::Plc };
        line.pass(start.elapsed(), from, bytes)
    };
    let [pc, plc] = cable.carry(pass, || {
        thread::scope(|scope| {
            let pc = scope.spawn(|| work(pc, pc_line, start, &done));
            let plc = scope.spawn(|| work(plc, plc_line, start, &done));
            let [pc, plc] =
                [pc.join(), plc.join()].map(|it| it.map_err(|_| anyhow!("a side panicked")));
            Ok([pc??, plc??])
        })
    })?;
    let summary = Report::new(line.finish(start.elapsed())?, &pc, &plc);
    artefacts.write_json("report.json", &summary)?;
    let names = artefacts.keep()?;
    print_summary(format!("{summary}in {}: {names}\n", args.out.display()))?;
    summary.check()?;
    print_summary("nothing was lost\n")?;
    Ok(ExitCode::SUCCESS)
}

/// Works until both sides are done, or one fails.
fn work(
    mut side: Side,
    line: &mut Driver<MAX_TELEGRAM>,
    start: Instant,
    done: &AtomicUsize,
) -> Result<Side> {
    let mut is_done = false;
    let mut turn = || -> Result<usize> {
        let event = line.wait(TURN)?;
        side.handle(start.elapsed(), event)?;
        if side.wants_recall() {
            line.cancel();
        }
        if !line.is_busy()
            && let Some(telegram) = side.poll_transmit(start.elapsed())
        {
            line.submit(&telegram)?;
        }
        let newly = side.is_done() && !is_done;
        is_done = side.is_done();
        Ok(newly.into())
    };
    while done.load(Ordering::Relaxed) < 2 {
        // One that fails ends the other's work too.
        let newly = turn().inspect_err(|_| _ = done.fetch_add(2, Ordering::Relaxed))?;
        done.fetch_add(newly, Ordering::Relaxed);
    }
    Ok(side)
}
