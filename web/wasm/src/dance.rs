//! The dancing robot: a score compiled and danced, and the files that this leaves.

use std::cell::RefCell;

use anyhow::{Context, Result, bail};
use dancer::{Choreography, Law, MOTORS, Report, Run, Score, ScoreError, ScorePart, simulate};
use pattern_codec::dance::Data;
use serde::Deserialize;
use serde_json::json;

use crate::answer::{self, Answer};
use crate::boundary::Request;
use crate::progress;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    score: String,
    law: String,
    /// Bytes of the firmware's code, which share the program memory.
    code_bytes: u64,
}

/// What was danced last: the files are written from it when they are asked for.
struct Danced {
    score: Score,
    dance: Choreography<MOTORS>,
    header: String,
    law: Law,
    code_bytes: u64,
    run: Run,
}

thread_local!(static LAST: RefCell<Option<Danced>> = const { RefCell::new(None) });

/// The text of a score as values, for the editor.
pub(crate) fn read(request: &Request) -> Result<Answer> {
    let text: String = request.parameters()?;
    // What is wrong with it is said as the score's own reader says it.
    text.parse::<Score>()?;
    Answer::new(toml::from_str::<toml::Table>(&text)?)
}

/// Compiles a score, dances its header, and gives what the page shows of it.
pub(crate) fn dance(request: &Request) -> Result<Answer> {
    let Parameters {
        score,
        law,
        code_bytes,
    } = request.parameters()?;
    let law: Law = law.parse()?;
    let (score, dance) = match compile(&score, law) {
        Ok(compiled) => compiled,
        Err(error) => return refused(&error),
    };
    let header = dancer::header(&score, &dance)?;
    let data = Data::<MOTORS>::read(&header).context("data.h")?;
    let told = told();
    let run = simulate(&data, law, std::io::sink(), told)?;
    let danced = Danced {
        score,
        dance,
        header,
        law,
        code_bytes,
        run,
    };
    let answer = danced.answer()?;
    LAST.set(Some(danced));
    Ok(answer)
}

fn told() -> impl Fn(u64, u64) {
    let teller = RefCell::new(progress::teller(0));
    move |done, all| teller.borrow_mut()(done, all)
}

fn compile(text: &str, law: Law) -> Result<(Score, Choreography<MOTORS>), ScoreError> {
    let score: Score = text.parse()?;
    let dance = score.compile(law)?;
    Ok((score, dance))
}

/// What is wrong, and which move it is, if it is one.
fn refused(error: &ScoreError) -> Result<Answer> {
    let number = match error.part {
        ScorePart::Move(number) => Some(number),
        ScorePart::Head | ScorePart::Motor(_) => None,
    };
    Answer::new(json!({ "refused": { "message": error.to_string(), "move": number } }))
}

impl Danced {
    fn with_report<T>(&self, take: impl FnOnce(&Report<'_>) -> Result<T>) -> Result<T> {
        let data = Data::<MOTORS>::read(&self.header).context("data.h")?;
        let report = Report::new(&self.score, &self.dance, &data, &self.run, self.code_bytes);
        take(&report)
    }

    fn answer(&self) -> Result<Answer> {
        let motors = self.score.motors();
        let motors = motors.map(|(name, deg)| json!({ "name": name, "halfStepDeg": deg }));
        let motors: Vec<_> = motors.collect();
        let value = self.with_report(|report| {
            Ok(json!({
                "summary": report.to_string(),
                "report": report,
                "isAsAsked": report.is_as_asked(),
                "motors": motors,
            }))
        })?;
        let positions = self.run.positions().as_flattened().iter();
        let other = self.run.other_positions().as_flattened().iter();
        Ok(Answer::new(value)?
            .with_numbers("positions", positions.map(|it| it.to_le_bytes()))
            .with_numbers("other", other.map(|it| it.to_le_bytes())))
    }

    /// The bus over time: the header is danced once more.
    fn bus(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let data = Data::<MOTORS>::read(&self.header).context("data.h")?;
        simulate(&data, self.law, &mut bytes, told())?;
        Ok(bytes)
    }
}

/// A file of what was danced last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    LAST.with_borrow(|last| {
        let last = last.as_ref().context("nothing has been danced yet")?;
        match &*name {
            "data.h" => answer::file(&*last.header),
            "dance.svg" => answer::file(dancer::picture(&last.score, &last.run).to_string()),
            "dance.vcd" => answer::file(last.bus()?),
            "report.json" => last.with_report(|report| answer::json_file(report)),
            _ => bail!("there is no file {name:?}"),
        }
    })
}
