#![cfg_attr(
    all(feature = "path-timing", feature = "pvt-steps", feature = "scara-kin"),
    doc = include_str!("../README.md")
)]
#![cfg_attr(
    not(all(feature = "path-timing", feature = "pvt-steps", feature = "scara-kin")),
    doc = "The facade of pose2pulse: each crate of the family under a feature of its name."
)]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "delta-kin")]
pub use delta_kin;
#[cfg(feature = "handwheel")]
pub use handwheel;
#[cfg(feature = "machine-kin")]
pub use machine_kin;
#[cfg(feature = "monitor3964r")]
pub use monitor3964r;
#[cfg(feature = "motor-phases")]
pub use motor_phases;
#[cfg(feature = "path-timing")]
pub use path_timing;
#[cfg(feature = "pattern-codec")]
pub use pattern_codec;
#[cfg(feature = "pose-pt")]
pub use pose_pt;
#[cfg(feature = "proto3964r")]
pub use proto3964r;
#[cfg(feature = "pulse-interp")]
pub use pulse_interp;
#[cfg(feature = "pvt-steps")]
pub use pvt_steps;
#[cfg(feature = "rk512")]
pub use rk512;
#[cfg(feature = "scara-kin")]
pub use scara_kin;
#[cfg(feature = "stepper-sync")]
pub use stepper_sync;

/// The programs of the book that are no examples.
#[cfg(all(
    doctest,
    feature = "path-timing",
    feature = "pvt-steps",
    feature = "scara-kin",
    feature = "stepper-sync"
))]
mod book {
    #[doc = include_str!("../docs/book/src/start.md")]
    #[doc = include_str!("../docs/book/src/arm.md")]
    #[doc = include_str!("../docs/book/src/limits.md")]
    mod programs {}
}
