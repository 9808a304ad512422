//! Lines and arcs that can be seen.

use pulse_interp::{Arc, Line, Rule, Turn};

use crate::common::grid::{Grid, grid};

fn line(to: [i32; 2]) -> Line {
    Line::new(to).unwrap()
}

#[test]
fn a_line_by_each_rule() {
    let line = line([9, 4]);
    let published = grid![
        ".......###",
        ".....###..",
        "...###....",
        ".###......",
        "##........",
    ];
    let nearest = grid![
        "........##",
        "......###.",
        "...####...",
        ".###......",
        "##........",
    ];
    let bresenham = grid![
        "........##",
        "......##..",
        "....##....",
        "..##......",
        "##........",
    ];
    assert_eq!(Grid::of([0, 0], line.steps(Rule::Published)), published);
    assert_eq!(Grid::of([0, 0], line.steps(Rule::Nearest)), nearest);
    assert_eq!(Grid::of([0, 0], line.moves()), bresenham);
}

#[test]
fn steep_and_upright_lines() {
    let down_left = grid!["...#", "..#.", "..#.", ".#..", ".#..", "#...", "#..."];
    assert_eq!(Grid::of([0, 0], line([-3, -6]).moves()), down_left);
    let up = grid!["#", "#", "#", "#"];
    assert_eq!(Grid::of([0, 0], line([0, 3]).steps(Rule::Published)), up);
}

#[test]
fn a_quarter_circle_by_each_rule() {
    let arc = Arc::new([7, 0], [0, 7], Turn::CounterClockwise).unwrap();
    let published = grid![
        "####....", "...##...", "....##..", ".....##.", "......#.", "......#.", "......#.",
        "+.....##",
    ];
    let nearest = grid![
        "####....", "...##...", "....##..", ".....##.", "......##", ".......#", ".......#",
        "+......#",
    ];
    let midpoint = grid![
        "###.....", "...##...", ".....#..", "......#.", "......#.", ".......#", ".......#",
        "+......#",
    ];
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Published)), published);
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Nearest)), nearest);
    assert_eq!(Grid::of(arc.start(), arc.moves()), midpoint);
}

/// The published rule goes in first: clockwise its circle leans the other way.
#[test]
fn a_circle_by_each_rule() {
    let arc = Arc::new([5, 0], [5, 0], Turn::Clockwise).unwrap();
    let published = grid![
        "...###.....",
        "..##.####..",
        ".##.....##.",
        ".#.......##",
        ".#........#",
        "##...+...##",
        "#........#.",
        "##.......#.",
        ".##.....##.",
        "..####.##..",
        ".....###...",
    ];
    let nearest = grid![
        "...#####...",
        ".###...###.",
        ".#.......#.",
        "##.......##",
        "#.........#",
        "#....+....#",
        "#.........#",
        "##.......##",
        ".#.......#.",
        ".###...###.",
        "...#####...",
    ];
    let midpoint = grid![
        "...#####...",
        "..#.....#..",
        ".#.......#.",
        "#.........#",
        "#.........#",
        "#....+....#",
        "#.........#",
        "#.........#",
        ".#.......#.",
        "..#.....#..",
        "...#####...",
    ];
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Published)), published);
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Nearest)), nearest);
    assert_eq!(Grid::of(arc.start(), arc.moves()), midpoint);
}

/// 0.4 steps outside the circle.
#[test]
fn an_end_that_was_rounded_is_met() {
    let arc = Arc::near([0, 6], [5, 4], Turn::Clockwise, 1000).unwrap();
    let nearest = grid!["###...", "..###.", "....##"];
    let midpoint = grid!["###...", "...#..", "....##"];
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Nearest)), nearest);
    assert_eq!(Grid::of(arc.start(), arc.moves()), midpoint);
}

/// The published rule passes the centre.
#[test]
fn the_smallest_circle() {
    let arc = Arc::new([1, 0], [1, 0], Turn::CounterClockwise).unwrap();
    let published = grid![".#.", "###", ".#."];
    let nearest = grid!["###", "#+#", "###"];
    let midpoint = grid![".#.", "#+#", ".#."];
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Published)), published);
    assert_eq!(Grid::of(arc.start(), arc.steps(Rule::Nearest)), nearest);
    assert_eq!(Grid::of(arc.start(), arc.moves()), midpoint);
}
