//! The transmitter's half of the procedure: what the other files decide, done.

use core::time::Duration;

use super::{
    Station,
    queue::{Note, Reply},
    state::{Burst, JobState, State},
};
use crate::{
    config::{Conflict, Priority},
    event::{Cause, Failure, JobPhase},
    frame::Encoder,
};

impl<const N: usize, const T: usize> Station<N, T> {
    /// Queues STX. The `burst` spoiled the attempt before.
    pub(super) fn request(&mut self, now: Duration, burst: Burst) {
        self.job.connection_attempts = self.job.connection_attempts.saturating_add(1);
        self.state = State::Request {
            stalled_at: now.saturating_add(self.config.qvz()),
            burst,
        };
    }

    /// The line is free again and a job waits.
    pub(super) fn resume(&mut self, now: Duration) {
        if self.job.state == JobState::Yielded {
            self.job.state = JobState::Open;
            self.next_connection(now, Cause::Conflict, Burst::NONE);
        } else {
            self.request(now, Burst::NONE);
        }
    }

    /// STX again, unless there were too many.
    pub(super) fn next_connection(&mut self, now: Duration, cause: Cause, burst: Burst) {
        let cause = *self.job.first_cause.get_or_insert(cause);
        if self.job.connection_attempts >= self.config.connection_attempts {
            self.fail(now, JobPhase::Connection, cause);
        } else {
            self.request(now, burst);
        }
    }

    /// The whole transmission again, from STX, unless there were too many.
    pub(super) fn next_transmission(&mut self, now: Duration, cause: Cause, burst: Burst) {
        let cause = *self.job.first_cause.get_or_insert(cause);
        if self.job.transmission_attempts >= self.config.transmission_attempts {
            self.fail(now, JobPhase::Transmission, cause);
        } else {
            self.job.transmission_attempts = self.job.transmission_attempts.saturating_add(1);
            self.job.connection_attempts = 0;
            self.request(now, burst);
        }
    }

    /// Breaks off what is left of the block, and begins again.
    pub(super) fn repeat_block(&mut self, now: Duration, cause: Cause, burst: Burst) {
        self.discard_rest();
        self.next_transmission(now, cause, burst);
    }

    /// The burst that begins with a wrong answer.
    fn burst_of(&self, now: Duration, cause: Cause) -> Burst {
        Burst {
            until: now.saturating_add(self.zvz),
            of_nak: cause == Cause::Nak,
        }
    }

    /// A wrong answer to STX, unless it came too soon to be one.
    pub(super) fn wrong_answer_to_stx(&mut self, now: Duration, cause: Cause) {
        if self.may_be_answer(now) {
            self.next_connection(now, cause, self.burst_of(now, cause));
        } else {
            self.extend_burst(now, cause == Cause::Nak);
        }
    }

    /// DLE that is no answer to STX, since that has not left. If nothing else comes, this is why.
    pub(super) fn answered_too_soon(&mut self, now: Duration) {
        if self.replies.is_empty() {
            self.job.first_cause.get_or_insert(Cause::TooSoon);
        }
        self.extend_burst(now, false);
    }

    /// One more character that is no answer.
    pub(super) fn extend_burst(&mut self, now: Duration, is_nak: bool) {
        let until = now.saturating_add(self.zvz);
        if let State::Request { burst, .. } | State::AwaitDle { burst, .. } = &mut self.state {
            burst.extend(now, until, is_nak);
        }
    }

    /// A wrong answer to the block, unless the block still goes out.
    pub(super) fn wrong_answer_to_block(&mut self, now: Duration, cause: Cause) {
        if now < self.end_of_output() {
            self.interrupted(now, cause);
        } else {
            self.repeat_block(now, cause, self.burst_of(now, cause));
        }
    }

    /// NAK to the block or into it. On a line that cannot take it back, the rest goes out first.
    pub(super) fn broken_off(&mut self, now: Duration) {
        if now < self.end_of_output() && !self.config.line.can_discard() {
            self.interrupted(now, Cause::Nak);
        } else {
            self.repeat_block(now, Cause::Nak, self.burst_of(now, Cause::Nak));
        }
    }

    /// A character in the block: silence has to be awaited, after what can no longer be held back.
    pub(super) fn interrupted(&mut self, now: Duration, cause: Cause) {
        self.job.first_cause.get_or_insert(cause);
        self.discard_rest();
        let end = self.end_of_rest(now);
        self.state = State::Interrupted {
            silent_at: end.saturating_add(self.zvz),
            noise_end_at: end.saturating_add(self.config.max_noise()),
        };
    }

    /// When what can no longer be held back has left.
    fn end_of_rest(&self, now: Duration) -> Duration {
        if self.discard {
            now
        } else {
            self.end_of_output().max(now)
        }
    }

    fn discard_rest(&mut self) {
        self.discard |= self.config.line.can_discard();
    }

    /// The last attempt is used up: NAK puts the partner into idle.
    fn fail(&mut self, now: Duration, phase: JobPhase, cause: Cause) {
        self.replies.push(Reply::Nak);
        self.close_failed(phase, cause);
        self.go_idle(now);
    }

    fn close_failed(&mut self, phase: JobPhase, cause: Cause) {
        let attempts = match phase {
            JobPhase::Connection => self.job.connection_attempts,
            JobPhase::Transmission => self.job.transmission_attempts,
        };
        self.close(Note::Failed(Failure {
            phase,
            cause,
            attempts,
        }));
    }

    fn close(&mut self, outcome: Note) {
        self.job.state = JobState::Ended;
        self.notes.result(outcome);
    }

    /// Ends the job from outside. If it has the line, NAK says so, and what the partner has not yet
    /// answered is waited out.
    pub(super) fn end_job(&mut self, now: Duration, cause: Cause) {
        let cause = *self.job.first_cause.get_or_insert(cause);
        let Some(phase) = self.state.phase() else {
            self.close_failed(JobPhase::Connection, cause);
            return;
        };
        if phase == JobPhase::Transmission {
            self.discard_rest();
        }
        self.replies.push(Reply::Nak);
        self.close_failed(phase, cause);
        let end = self.end_of_rest(now);
        self.state = State::Settling {
            silent_at: end.saturating_add(self.zvz),
            noise_end_at: end.saturating_add(self.config.max_noise()),
        };
    }

    /// The partner answered DLE.
    pub(super) fn connected(&mut self, now: Duration) {
        if let State::AwaitDle {
            in_conflict: true, ..
        } = self.state
        {
            self.conflicts = 0; // it gave way, as its priority wants it
        }
        self.send_block(now);
    }

    pub(super) fn send_block(&mut self, now: Duration) {
        self.state = State::Sending {
            block: Encoder::START,
            begun_at: now,
        };
    }

    /// The partner acknowledged the block.
    pub(super) fn sent(&mut self, now: Duration) {
        self.close(Note::Sent);
        self.go_idle(now);
    }

    /// Serves the partner first.
    pub(super) fn give_way(&mut self, now: Duration) {
        self.job.state = JobState::Yielded;
        self.asked_to_receive(now);
    }

    /// The partner sent STX too.
    pub(super) fn conflict(&mut self, now: Duration) {
        let gives_way = match self.config.priority {
            Priority::Low => true,
            Priority::High => {
                self.config.conflict == Conflict::YieldOnRetry && self.job.connection_attempts > 1
            }
        };
        if let State::Request { burst, .. } = self.state {
            // The next STX would meet the DLE that the one before has earned.
            self.state = State::AwaitDle {
                answer_at: now.saturating_add(self.config.qvz()),
                burst,
                in_conflict: false,
            };
        }
        self.count_conflict(gives_way);
        if gives_way {
            self.give_way(now);
            return;
        }
        self.job.first_cause.get_or_insert(Cause::Conflict);
        if let State::AwaitDle { answer_at, .. } = &mut self.state
            && self.config.conflict == Conflict::Repeat
        {
            // By then a partner that gave way waits for no data any more, of which STX would be.
            *answer_at = now.saturating_add(self.zvz).min(*answer_at);
        }
    }

    /// Reports a conflict, once in each connection attempt.
    fn count_conflict(&mut self, gives_way: bool) {
        let State::AwaitDle { in_conflict, .. } = &mut self.state else {
            return;
        };
        if core::mem::replace(in_conflict, true) {
            return;
        }
        self.conflicts = self.conflicts.saturating_add(1);
        self.notes.diagnosis(Note::Conflict(self.conflicts));
        if self.conflicts == 2 && !gives_way {
            self.notes.diagnosis(Note::SamePriority);
        }
    }
}
