//! Display blocks bring a pendant to show a screen.

use handwheel::{Cell, LcdCommand, Model};
use platform::{Screen, Shown};
use proptest::prelude::*;

proptest! {
    /// Blocks until nothing differs; the pendant then shows the screen.
    #[test]
    fn updates_reach_the_screen(
        model in prop::sample::select(vec![Model::Hbls, Model::Hbas]),
        screens in prop::collection::vec(prop::collection::vec(b' '..=b'~', 128), 1..4),
    ) {
        let mut shown = Shown::UNKNOWN;
        let mut display = [[0; 16]; 8];
        for cells in screens {
            let mut screen = Screen::BLANK;
            for (line, cells) in cells.chunks(16).enumerate() {
                screen.put(line, 0, core::str::from_utf8(cells).unwrap());
            }
            let mut blocks = 0;
            while let Some(block) = shown.update(&screen, model) {
                blocks += 1;
                let mut at = (0, 0);
                for command in block.commands() {
                    match command.unwrap() {
                        LcdCommand::Goto(Cell { line, column }) => {
                            at = (usize::from(line.get()), usize::from(column.get()));
                        }
                        LcdCommand::Text(text) => for character in text.chars() {
                            display[at.0][at.1] = u8::try_from(character).unwrap();
                            at.1 += 1;
                        },
                        other => prop_assert!(false, "{:?}", other),
                    }
                }
            }
            prop_assert!(blocks <= 2);
            prop_assert_eq!(display.concat(), cells);
        }
    }
}
