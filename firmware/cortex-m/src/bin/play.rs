//! On a board: plays a line that a PC has planned, and one that the board plans itself, by timer
//! interrupts; says when each edge came. On a PC: writes the first line, and checks the edges.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg_attr(target_os = "none", path = "play/board.rs")]
#[cfg_attr(not(target_os = "none"), path = "play/pc.rs")]
mod machine;

#[cfg(not(target_os = "none"))]
fn main() {
    machine::main();
}
