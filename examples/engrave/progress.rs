//! A progress bar that appears when something takes longer than a second.

use core::cell::Cell;
use core::time::Duration;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);

/// Progress of `total` units; shown on standard error, if that is a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    hidden: Cell<bool>,
}

impl Progress {
    pub(crate) fn new(what: &'static str, total: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden())
            .with_message(what);
        if let Ok(style) =
            ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} % {eta:>4}")
        {
            bar.set_style(style);
        }
        Self {
            bar,
            begun: Instant::now(),
            hidden: Cell::new(true),
        }
    }

    pub(crate) fn advance(&self, units: u64) {
        self.bar.inc(units);
        if self.hidden.get() && self.begun.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.hidden.set(false);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
