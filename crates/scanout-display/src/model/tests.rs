//! The model against streams written by hand.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use super::*;

/// Awake, on, 16 bits a pixel.
fn started(madctl: u8) -> DisplayModel {
    let mut model = DisplayModel::default();
    send(&mut model, &[(0x11, &[]), (0x3a, &[0x55]), (0x36, &[madctl]), (0x29, &[])]);
    model
}

fn try_send(model: &mut DisplayModel, commands: &[(u8, &[u8])]) -> Result<(), Fault> {
    commands.iter().try_for_each(|(command, data)| {
        model.feed(*command, false).and_then(|()| model.feed_all(data, true)).map_err(|e| e.fault)
    })
}

fn send(model: &mut DisplayModel, commands: &[(u8, &[u8])]) {
    try_send(model, commands).unwrap();
}

/// CASET and RASET.
fn window(x: [u16; 2], y: [u16; 2]) -> [(u8, Vec<u8>); 2] {
    let bytes = |ends: [u16; 2]| ends.iter().flat_map(|v| v.to_be_bytes()).collect();
    [(0x2a, bytes(x)), (0x2b, bytes(y))]
}

fn set_window(model: &mut DisplayModel, x: [u16; 2], y: [u16; 2]) -> Result<(), Fault> {
    window(x, y).iter().try_for_each(|(command, data)| try_send(model, &[(*command, data)]))
}

/// Part of the picture as text: `.` untouched black, else the pixel's low digit.
fn pattern(model: &DisplayModel, left: u16, top: u16, width: u16, height: u16) -> Vec<String> {
    let part = model.picture().unwrap().crop(left, top, width, height).unwrap();
    let digit = |&p: &u16| if p == 0 { '.' } else { char::from_digit(p as u32 & 15, 16).unwrap() };
    part.pixels.chunks(width as usize).map(|row| row.iter().map(digit).collect()).collect()
}

/// Pixels 1, 2, 3, ...
fn count(n: u16) -> Vec<u8> {
    (1..=n).flat_map(u16::to_be_bytes).collect()
}

#[test]
fn a_window_is_filled_row_by_row_and_wraps_inside() {
    let mut model = started(0);
    set_window(&mut model, [1, 3], [1, 2]).unwrap();
    send(&mut model, &[(0x2c, &count(6))]);
    assert_eq!(pattern(&model, 0, 0, 5, 4), [".....", ".123.", ".456.", "....."]);
    assert_eq!((model.counts().windows_filled, model.counts().wrapped_pixels), (1, 0));
    // Two more pixels begin at the window's start again, and nothing else is touched.
    send(&mut model, &[(0x2c, &count(8))]);
    assert_eq!(pattern(&model, 0, 0, 5, 4), [".....", ".783.", ".456.", "....."]);
    assert_eq!(model.counts().wrapped_pixels, 2);
    assert_eq!(model.untouched(), 76_800 - 6);
}

#[test]
fn memory_write_continues_where_it_stopped() {
    let mut model = started(0);
    set_window(&mut model, [0, 2], [0, 1]).unwrap();
    send(&mut model, &[(0x2c, &count(2)), (0x00, &[]), (0x3c, &[0, 9, 0, 10])]);
    assert_eq!(pattern(&model, 0, 0, 4, 3), ["129.", "a...", "...."]);
    // Once the window is set anew there is nothing to continue.
    set_window(&mut model, [0, 1], [0, 0]).unwrap();
    assert_eq!(try_send(&mut model, &[(0x3c, &[])]), Err(Fault::NothingToContinue));
}

/// Address (0, 0), (1, 0) and (0, 1) in the eight settings of MY, MX, MV, by the corner of the memory where they lie.
#[test]
fn orientations_by_hand() {
    let (right, bottom) = (238, 318);
    for (madctl, left, top, rows) in [
        (0x00, 0, 0, ["12", "3."]),
        (0x40, right, 0, ["21", ".3"]),
        (0x80, 0, bottom, ["3.", "12"]),
        (0xc0, right, bottom, [".3", "21"]),
        (0x20, 0, 0, ["13", "2."]),
        (0x60, right, 0, ["31", ".2"]),
        (0xa0, 0, bottom, ["2.", "13"]),
        (0xe0, right, bottom, [".2", "31"]),
    ] {
        let mut model = started(madctl);
        set_window(&mut model, [0, 1], [0, 0]).unwrap();
        send(&mut model, &[(0x2c, &[0, 1, 0, 2])]);
        set_window(&mut model, [0, 0], [1, 1]).unwrap();
        send(&mut model, &[(0x2c, &[0, 3])]);
        assert_eq!(pattern(&model, left, top, 2, 2), rows, "{madctl:02x}");
        assert_eq!(model.untouched(), 76_800 - 3);
        // The last address of both.
        let (columns, lines) = if madctl & 0x20 != 0 { (319, 239) } else { (239, 319) };
        assert_eq!(set_window(&mut model, [columns; 2], [lines; 2]), Ok(()));
        let too_far =
            Fault::OutsideMemory { command: 0x2a, ends: [0, columns + 1], count: columns + 1 };
        assert_eq!(set_window(&mut model, [0, columns + 1], [0, 0]), Err(too_far));
    }
}

/// A window set before the orientation was turned may not fit any more; that is found when pixels begin.
#[test]
fn turning_after_the_window() {
    let mut model = started(0x20);
    set_window(&mut model, [0, 319], [0, 239]).unwrap();
    let fault = Fault::OutsideMemory { command: 0x2a, ends: [0, 319], count: 240 };
    assert_eq!(try_send(&mut model, &[(0x36, &[0]), (0x2c, &[])]), Err(fault));
}

#[test]
fn pixels_of_18_bits() {
    let mut model = started(0);
    send(&mut model, &[(0x3a, &[0x66]), (0x2c, &[0xfc, 0x80, 0x04, 0xff, 0xff, 0xff])]);
    let seen = model.seen().unwrap();
    assert_eq!((seen.at(0, 0), seen.at(1, 0)), ([255, 0x82, 0x04], [255; 3]));
    assert_eq!(model.picture().unwrap().at(0, 0), 0xfc00);
    assert_eq!(model.counts().pixels, 2);
}

#[test]
fn the_default_is_18_bits_and_software_reset_keeps_the_format() {
    let mut model = DisplayModel::default();
    assert_eq!(model.registers().pixel, PixelSize::Bits18);
    send(&mut model, &[(0x3a, &[0x05]), (0x36, &[0x60]), (0x11, &[]), (0x29, &[]), (0x21, &[])]);
    set_window(&mut model, [5, 6], [7, 8]).unwrap();
    send(&mut model, &[(0x01, &[])]);
    let r = model.registers();
    assert_eq!((r.awake, r.on, r.inverted), (false, false, false));
    assert_eq!((r.madctl, r.pixel), (0x60, PixelSize::Bits16));
    assert_eq!((r.window.columns, r.window.rows), ([0, 319], [0, 239]));
    // What was being written can't be continued.
    let continued: [(u8, &[u8]); 3] = [(0x2c, &[0, 1]), (0x01, &[]), (0x3c, &[])];
    let mut cut = model.clone();
    send(&mut cut, &[(0x11, &[])]);
    assert_eq!(try_send(&mut cut, &continued), Err(Fault::NothingToContinue));
    // The pin resets these too.
    model.reset(false);
    model.reset(true);
    assert_eq!(model.registers(), Registers::RESET);
    assert_eq!(model.counts().resets, 1);
}

#[test]
fn colour_order_and_inversion_as_the_glass_is_made() {
    let shown = |glass, madctl, invert| {
        let mut model = DisplayModel::new(glass);
        send(&mut model, &[(0x11, &[]), (0x29, &[]), (0x3a, &[0x55]), (0x36, &[madctl])]);
        send(&mut model, &[(invert, &[]), (0x2c, &[0xf8, 0x00])]);
        assert_eq!(model.picture().unwrap().at(0, 0), 0xf800, "as sent");
        model.seen().unwrap().at(0, 0)
    };
    let (plain, bgr) = (Glass::default(), Glass { bgr: true, inverted: false });
    let ips = Glass { bgr: false, inverted: true };
    assert_eq!(shown(plain, 0x00, 0x20), [255, 0, 0]);
    assert_eq!(shown(plain, 0x08, 0x20), [0, 0, 255]);
    assert_eq!(shown(bgr, 0x08, 0x20), [255, 0, 0]);
    assert_eq!(shown(bgr, 0x00, 0x20), [0, 0, 255]);
    assert_eq!(shown(ips, 0x00, 0x21), [255, 0, 0]);
    assert_eq!(shown(ips, 0x00, 0x20), [0, 255, 255]);
}

#[test]
fn partial_mode_and_scrolling() {
    let mut model = started(0);
    for row in 0..320u16 {
        set_window(&mut model, [0, 0], [row, row]).unwrap();
        // Green holds the row: 6 bits, so every fifth row differs from its neighbours.
        send(&mut model, &[(0x2c, &((row / 5) << 5).to_be_bytes())]);
    }
    let row_of = |model: &DisplayModel, row: u16| {
        let [_, g, _] = model.seen().unwrap().at(0, row);
        (g >> 2) as u16 * 5
    };
    send(&mut model, &[(0x30, &[0, 20, 0, 29]), (0x12, &[])]);
    let rows = [0, 15, 20, 25, 30].map(|row| row_of(&model, row));
    assert_eq!(rows, [0, 0, 20, 25, 0]);
    send(&mut model, &[(0x13, &[])]);
    assert_eq!(row_of(&model, 300), 300);
    // 40 rows stay on top, 200 scroll, 80 stay below.
    send(&mut model, &[(0x33, &[0, 40, 0, 200, 0, 80]), (0x37, &[0, 100])]);
    let rows = [0, 35, 40, 175, 180, 235, 240, 315].map(|row| row_of(&model, row));
    assert_eq!(rows, [0, 35, 100, 235, 40, 95, 240, 315]);
    // Partial mode and normal mode both end scrolling.
    send(&mut model, &[(0x30, &[0, 50, 0, 59]), (0x12, &[])]);
    assert_eq!([25, 50, 55, 60].map(|row| row_of(&model, row)), [0, 50, 55, 0]);
    send(&mut model, &[(0x13, &[])]);
    assert_eq!(row_of(&model, 40), 40);
    let sum = Fault::OutsideMemory { command: 0x33, ends: [0, 320], count: 320 };
    assert_eq!(try_send(&mut model, &[(0x33, &[0, 0, 1, 64, 0, 1])]), Err(sum));
}

#[test]
fn each_fault_says_what_is_wrong() {
    let cut = Fault::PixelCut { given: 1, needed: 2 };
    let missing = |given| Fault::MissingParameters { command: 0x2a, needed: 4, given };
    let many = |command, most| Fault::TooManyParameters { command, most };
    let reversed = Fault::Reversed { command: 0x2b, ends: [5, 4] };
    type Stream = Vec<(u8, &'static [u8])>;
    let cases: Vec<(Stream, Fault, &str)> = vec![
        (vec![(0x2f, &[])], Fault::UnknownCommand(0x2f), "no command 2fh"),
        (
            vec![(0x2a, &[0, 0, 0]), (0x2c, &[])],
            missing(3),
            "CASET (2Ah) takes 4 parameters and has 3",
        ),
        (
            vec![(0x2a, &[0, 0, 0, 1, 0])],
            many(0x2a, 4),
            "CASET (2Ah) takes 4 parameters and has more",
        ),
        (vec![(0x29, &[0])], many(0x29, 0), "DISPON"),
        (
            vec![(0x3a, &[0x53])],
            Fault::BadParameter { command: 0x3a, value: 0x53 },
            "COLMOD (3Ah) with 53h",
        ),
        (vec![(0x10, &[]), (0x2c, &[1])], Fault::PixelsAsleep, "SLPOUT (11h) first"),
        (vec![(0x2b, &[0, 5, 0, 4])], reversed, "RASET (2Bh) from 5 to 4"),
        (vec![(0x2c, &[1]), (0x00, &[])], cut, "after 1 of 2 bytes"),
        (vec![(0x3c, &[])], Fault::NothingToContinue, "RAMWRC"),
    ];
    for (stream, fault, text) in cases {
        let mut model = started(0);
        assert_eq!(try_send(&mut model, &stream), Err(fault));
        let error = model.fault().unwrap();
        assert!(error.to_string().contains(text), "{error}");
        // The model stays at the fault.
        assert_eq!(model.feed(0x00, false), Err(error));
        assert_eq!(model.picture(), Err(error));
    }
}

#[test]
fn a_picture_needs_a_complete_stream_and_a_display_that_is_on() {
    let asked = |model: &DisplayModel| {
        let answers = (model.picture().map(|_| ()), model.seen().map(|_| ()));
        assert_eq!(answers.0, answers.1);
        answers.0.map_err(|e| e.fault)
    };
    let mut model = DisplayModel::default();
    assert_eq!(asked(&model), Err(Fault::Asleep));
    send(&mut model, &[(0x11, &[])]);
    assert_eq!(asked(&model), Err(Fault::DisplayOff));
    send(&mut model, &[(0x29, &[])]);
    assert_eq!(asked(&model), Ok(()));
    send(&mut model, &[(0x3a, &[])]);
    let missing = Fault::MissingParameters { command: 0x3a, needed: 1, given: 0 };
    assert_eq!(asked(&model), Err(missing));
    // Asking is no fault of the stream.
    model.feed(0x55, true).unwrap();
    send(&mut model, &[(0x2c, &[0x12])]);
    assert_eq!(asked(&model), Err(Fault::PixelCut { given: 1, needed: 2 }));
    model.feed(0x34, true).unwrap();
    assert_eq!(model.picture().unwrap().at(0, 0), 0x1234);
    send(&mut model, &[(0x28, &[])]);
    assert_eq!(asked(&model), Err(Fault::DisplayOff));
}

#[test]
fn data_first_and_bytes_in_reset() {
    let mut model = DisplayModel::default();
    let error = model.feed(0x11, true).unwrap_err();
    assert_eq!(error, ModelError { at: 0, fault: Fault::DataBeforeCommand(0x11) });
    assert!(error.to_string().starts_with("byte 0: data 11h before any command"));

    let mut model = started(0);
    model.reset(false);
    assert_eq!(try_send(&mut model, &[(0x11, &[])]), Err(Fault::HeldInReset));
    let mut model = started(0);
    model.reset(false);
    model.reset(true);
    assert_eq!(model.feed(0, true).unwrap_err().fault, Fault::DataBeforeCommand(0));
}

/// The start-up that the manufacturer's application notes give, with voltages and gamma, as common drivers send it.
#[test]
fn a_long_start_up_is_taken() {
    let gamma = [0xd0, 0, 2, 7, 10, 0x28, 0x32, 0x44, 0x42, 6, 14, 12, 0x14, 0x17];
    let mut model = DisplayModel::default();
    send(&mut model, &[(0x01, &[]), (0x11, &[]), (0x13, &[]), (0x36, &[0]), (0x00, &[])]);
    send(&mut model, &[(0xb2, &[12, 12, 0, 0x33, 0x33]), (0xb7, &[0x35]), (0xbb, &[0x28])]);
    send(&mut model, &[(0xc0, &[12]), (0xc2, &[1, 0xff]), (0xc3, &[16]), (0xc4, &[32])]);
    send(&mut model, &[(0xc2, &[1]), (0xc6, &[15]), (0xd0, &[0xa4, 0xa1])]);
    send(&mut model, &[(0xe0, &gamma), (0xe1, &gamma), (0x21, &[]), (0x3a, &[0x55]), (0x29, &[])]);
    // A read: the answer's clocks carry bytes that mean nothing.
    send(&mut model, &[(0x04, &[0, 0, 0, 0]), (0x35, &[0])]);
    let counts = model.counts();
    assert_eq!(counts.commands, 22);
    assert_eq!(counts.bytes, counts.commands + counts.parameters + 4);
    assert!(model.picture().is_ok());
}
