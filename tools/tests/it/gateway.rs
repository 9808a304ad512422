//! `gateway` from outside: lines of simulated partners, a broker (mosquitto), its clients.

mod basics;
mod broker;
mod commands;
mod connections;
mod day;
mod discovery;
mod faults;
mod health;
mod listeners;
mod load;
mod nats;
mod nats_server;
mod noise;
mod partner;
mod process;
mod refused;
mod reload;
mod safe;
mod scale;
mod served;
mod sparkplug;
mod subscriber;
mod uart;
mod verdicts;
mod versions;

/// The broker, or an end of the test that is seen: it must not be missed where
/// `POSE2PULSE_REQUIRE_MOSQUITTO` is set.
macro_rules! broker_or_skip {
    () => {
        match crate::gateway::broker::Broker::start() {
            Some(broker) => broker,
            None => return,
        }
    };
}
pub(crate) use broker_or_skip;
