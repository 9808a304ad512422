//! What a command on the line asks for, and what a broken one is answered with.
//!
//! `cargo run -p rk512 --example read_a_command`

use rk512::{Command, Config, MAX_DATA};

fn main() {
    // From captures: SEND to DB 10 from DW 2 on, FETCH of DB 10, one whose area there is not.
    let blocks: [&[u8]; 3] = [
        &[0, 0, b'A', b'D', 10, 2, 0, 2, 0xFF, 0xFF, 1, 2, 3, 4],
        &[0, 0, b'E', b'D', 10, 0, 0, 100, 0xFF, 0xFF],
        &[0, 0, b'E', b'?', 10, 0, 0, 100, 0xFF, 0xFF],
    ];
    for block in blocks {
        match Command::decode(block) {
            Ok((command, data)) => {
                println!(
                    "{command}: bytes {} to {}, {:?}",
                    command.byte_start(),
                    command.byte_start() + command.byte_len(),
                    command.coordination()
                );
                let side = if command.is_send() {
                    "the commands"
                } else {
                    "the reactions"
                };
                let telegrams = command.byte_len().div_ceil(MAX_DATA);
                println!(
                    "  data go with {side}, in {telegrams} telegrams; {} here",
                    data.len()
                );
            }
            Err(error) => println!("{error}: answered with {}", error.reaction()),
        }
    }
    let wait = Config::reaction_time_for(9600);
    println!("at 9600 bit/s a reaction comes within {wait:?}");
}
