//! The machines behind plain exports for a page in a browser: a call names an operation and brings
//! its input as JSON and bytes; its result is JSON and named bytes, or one line for a person, the
//! same that the command line prints.

#[cfg(feature = "align")]
mod align;
mod answer;
mod boundary;
#[cfg(feature = "dance")]
mod dance;
#[cfg(feature = "delta")]
mod delta;
#[cfg(feature = "engrave")]
mod engrave;
#[cfg(any(feature = "delta", feature = "engrave", feature = "stage"))]
mod limits;
#[cfg(feature = "line")]
mod line;
#[cfg(any(feature = "delta", feature = "engrave", feature = "stage"))]
mod load;
#[cfg(any(
    feature = "dance",
    feature = "engrave",
    feature = "line",
    feature = "stage"
))]
mod progress;
#[cfg(feature = "stage")]
mod stage;

use anyhow::{Result, bail};

use crate::answer::Answer;
use crate::boundary::Request;

/// What the page can ask for.
fn perform(request: &Request) -> Result<Answer> {
    match request.operation()? {
        #[cfg(feature = "engrave")]
        "engrave" => engrave::engrave(request),
        #[cfg(feature = "engrave")]
        "engrave.file" => engrave::file(request),
        #[cfg(feature = "dance")]
        "dance" => dance::dance(request),
        #[cfg(feature = "dance")]
        "dance.read" => dance::read(request),
        #[cfg(feature = "dance")]
        "dance.file" => dance::file(request),
        #[cfg(feature = "stage")]
        "stage" => stage::stage(request),
        #[cfg(feature = "stage")]
        "stage.preview" => stage::preview(request),
        #[cfg(feature = "stage")]
        "stage.telegrams" => stage::telegrams(request),
        #[cfg(feature = "stage")]
        "stage.file" => stage::file(request),
        #[cfg(feature = "delta")]
        "delta" => delta::delta(request),
        #[cfg(feature = "delta")]
        "delta.calibrate" => delta::calibrate(request),
        #[cfg(feature = "delta")]
        "delta.report" => delta::report(),
        #[cfg(feature = "delta")]
        "delta.file" => delta::file(request),
        #[cfg(feature = "align")]
        "align" => align::align(request),
        #[cfg(feature = "align")]
        "align.file" => align::file(request),
        #[cfg(feature = "align")]
        "desk" => align::begin(request),
        #[cfg(feature = "align")]
        "desk.turn" => align::turn(request),
        #[cfg(feature = "line")]
        operation if operation.starts_with("line") => line::perform(operation, request),
        other => bail!("there is no operation {other:?}"),
    }
}
