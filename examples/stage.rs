//! G-code becomes step pulses for a two-axis stage, with the loop closed over its scales: the
//! command line of `machines/stage`.
//!
//! ```text
//! G-code -> lines and arcs in mm -> curves -> rows -> pulses -> simulated motors, which may lose some
//!                                                       ^                      |
//!                                                       +-- corrections <--- linear scales
//! ```
//! The simulated stage gets nothing but the pulses. Beside it runs one without corrections. Where
//! the torque of the motors does not allow the motion, as with `--steps nearest`, the first line
//! says how many steps are lost, and the exit status is 2.
//!
//! `cargo run --release --example stage -- [--gcode FILE | --port TTY] [--machine FILE] [--offset X,Y | --fit] [--steps WHEN] [--tolerance MM] [--lose-steps P] [--seed N] [--out DIR]`

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use command_line::{Artefacts, Terminal, fraction, print_notes, print_summary, read, read_bytes};
use stage::{Machine, Program, Run, Session, Settings, StepLog, StepObserver, Stepping};

/// Of the terminal.
const BAUD: u32 = 9600;

/// Exit status of a run in which the simulated motors lose steps.
const LOST_STEPS: u8 = 2;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/stage");

/// Moves a simulated two-axis stage along G-code.
#[derive(Parser, Debug)]
#[command(version)]
struct Args {
    /// The drawing: G0 G1 G2 G3 with I J or R, G20 G21 G90 G91 G90.1 G91.1, F, M2 M30. What else
    /// moves neither X nor Y is passed over with a note, what would is refused.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("drawings/test.gcode"))]
    gcode: PathBuf,
    /// The machine, as in machines/stage/machine.toml.
    #[arg(long, value_name = "FILE", default_value_os_t = PathBuf::from(FOLDER).join("machine.toml"))]
    machine: PathBuf,
    /// Takes lines from this terminal instead, and answers each; `?` reports the position, the
    /// keys < > v ^ jog by a millimetre, M2 ends.
    #[arg(long, value_name = "TTY", conflicts_with = "gcode")]
    port: Option<String>,
    /// Where the drawing's zero is, in mm from that of the stage.
    #[arg(long, value_name = "X,Y",  value_parser = pair, allow_negative_numbers = true, conflicts_with_all = ["fit", "port"])]
    offset: Option<[f64; 2]>,
    /// Puts a drawing that leaves the travel of 120 by 100 mm within it.
    #[arg(long, conflicts_with = "port")]
    fit: bool,
    /// When the axes step: `timed`, each by itself within what the motors follow; or at the feed
    /// from the first step to the last, as published: one axis at a time as `published`, the one
    /// with the `nearest` point, or both where due, `bresenham`.
    #[arg(long, value_name = "WHEN", default_value_t)]
    steps: Stepping,
    /// How far timed steps may leave straight lines to pass their corners faster, in mm. Arcs are
    /// arcs.
    #[arg(long, value_name = "MM", default_value_t = Settings::default().tolerance_mm, allow_negative_numbers = true)]
    tolerance: f64,
    /// The fraction of steps that the motors lose, as 0.001 or 0.1%.
    #[arg(long, value_name = "P", default_value = "0", value_parser = fraction, allow_negative_numbers = true)]
    lose_steps: f64,
    /// Which steps are lost.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Where the artefacts go.
    #[arg(long, value_name = "DIR", default_value = "target/stage")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command_line::run(stage)
}

/// Where the motions come from.
enum Source {
    Program(Program),
    Terminal(Terminal),
}

fn stage(args: &Args) -> Result<ExitCode> {
    let machine = read(&args.machine, Machine::parse)?;
    let settings = Settings {
        stepping: args.steps,
        tolerance_mm: args.tolerance,
        lose_steps: args.lose_steps,
        seed: args.seed,
    };
    let port = args.port.clone();
    let name = port.unwrap_or_else(|| args.gcode.display().to_string());
    let source = match &args.port {
        Some(port) => Source::Terminal(Terminal::open_port(port, BAUD)?),
        // All of it is checked before anything moves.
        None => {
            let bytes = read_bytes(&args.gcode)?;
            Source::Program(placed(args, Program::from_bytes(&bytes)).context(name.clone())?)
        }
    };
    let mut artefacts = Artefacts::new(&args.out)?;
    let mut log = StepLog::new(artefacts.create("steps.csv")?)?;
    let mut observer = |ticks, by| log.step(ticks, by);
    let (run, notes) = match source {
        Source::Terminal(terminal) => {
            serve(terminal, (&machine, &settings), &mut observer).context(name)?
        }
        Source::Program(program) => {
            let run = stage::run(&machine, &program, &settings, &mut observer).context(name)?;
            print_notes(&args.gcode, &program.notes());
            (run, program.notes())
        }
    };
    log.finish()?;
    artefacts.write("stage.svg", run.picture().to_string())?;
    let report = run.report().with_notes(notes);
    artefacts.write_json("report.json", &report)?;
    let names = artefacts.keep()?;
    print_summary(format!("{report}in {}: {names}\n", args.out.display()))?;
    let is_followed = report.check().is_ok();
    Ok(ExitCode::from(if is_followed { 0 } else { LOST_STEPS }))
}

/// Two numbers with a comma between.
fn pair(text: &str) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|word| word.trim().parse().ok())
        .collect();
    let pair = numbers.and_then(|numbers| numbers.try_into().ok());
    pair.ok_or_else(|| format!("{text:?} is not two numbers with a comma between"))
}

/// The program where the stage shall have it.
fn placed(args: &Args, program: Result<Program>) -> Result<Program> {
    let program = program?;
    match args.offset {
        Some(offset) => program.with_offset(offset),
        _ if args.fit => program.fit(),
        _ => Ok(program),
    }
}

/// Answers lines and keys until the end of the program or of the line.
fn serve(
    mut terminal: Terminal,
    (machine, settings): (&Machine, &Settings),
    observer: StepObserver<'_>,
) -> Result<(Run, Vec<String>)> {
    let mut session = Session::new(machine, settings, observer)?;
    while !session.is_over()
        && let Some(byte) = terminal.read_byte()?
    {
        if let Some(answer) = session.handle_byte(byte) {
            terminal.answer(&answer)?;
        }
    }
    session.finish()
}
