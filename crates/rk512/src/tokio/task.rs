//! The task of a client.

use std::io;

use ::tokio::{sync::mpsc, time::Instant};
use proto3964r::{
    Event,
    tokio::{Caller, StreamDriver, sleep},
};

use super::{
    Job,
    held::{HeldJob, Holding},
};
use crate::{
    reaction::ReactionError,
    session::{Session, Transport},
    source::DataSource,
    telegram::MAX_TELEGRAM,
};

type LineDriver = StreamDriver<MAX_TELEGRAM>;

/// Works until the client is dropped.
///
/// # Errors
/// The errors of the stream.
pub(super) async fn work<D: DataSource>(
    mut line: LineDriver,
    mut jobs: mpsc::Receiver<Job>,
    mut session: Session<D>,
    held: mpsc::Sender<HeldJob>,
    mut observer: impl FnMut(Event<'_>),
) -> io::Result<()> {
    let epoch = Instant::now();
    let mut caller = Caller::NONE;
    // Of the partner's job whose reaction waits.
    let mut holding = Holding::NOTHING;
    loop {
        if let Some(outcome) = session.step(epoch.elapsed(), &mut line)? {
            caller.tell(outcome);
        }
        if let Some(is_delivered) = session.take_ended() {
            holding.ends(is_delivered);
        }
        if let Some(command) = session.take_held()
            && held.try_send(holding.about(command)).is_err()
        {
            // Its user does not ask.
            session.confirm(Err(ReactionError::JobFailed));
            continue;
        }
        let (due, is_idle) = (session.poll_timeout(), !session.is_busy());
        ::tokio::select! {
            event = line.wait() => match event {
                Ok(event) => {
                    observer(event);
                    session.handle(epoch.elapsed(), event);
                }
                Err(error) => line.take_damage(error)?,
            },
            job = jobs.recv(), if is_idle => {
                let Some(job) = job else {
                    return Ok(());
                };
                caller = job.caller;
                if let Err(error) = session.submit(job.command, &job.data) {
                    caller.tell(Err(error.into()));
                }
            }
            () = caller.gone() => session.cancel(epoch.elapsed()),
            result = holding.answered() => {
                if !session.confirm(result) {
                    holding.ends(false);
                }
            }
            () = sleep(epoch, due) => {}
        }
    }
}

impl Transport for LineDriver {
    fn is_busy(&self) -> bool {
        self.is_busy()
    }

    fn submit(&mut self, telegram: &[u8]) -> Result<(), proto3964r::SubmitError> {
        self.submit(telegram)
    }

    fn cancel(&mut self) {
        self.cancel();
    }
}
