//! Which bit patterns are markers.
//!
//! ```text
//!  # # # # # #      a marker of side 4: a black border of one cell around 4 x 4 cells,
//!  # 1 0 1 1 #      white = 1, rows from the top, the first cell in the highest bit:
//!  # 0 1 0 1 #      0b1011_0101_0011_0010 = 0xb532, number 0 of 4x4_50
//!  # 0 0 1 1 #
//!  # 0 0 1 0 #
//!  # # # # # #
//! ```
//!
//! The patterns are facts taken from OpenCV (ArUco: Garrido-Jurado et al., "Automatic generation and detection of highly reliable
//! fiducial markers under occlusion", 2014; AprilTag 36h11: Olson, "AprilTag", 2011, and Wang and Olson, 2016) by
//! `scripts/dictionaries.py`, which also checks them.

mod tables;

/// A table of patterns in its narrowest word.
#[derive(Clone, Copy, Debug)]
enum Codes {
    U16(&'static [u16]),
    U32(&'static [u32]),
    U64(&'static [u64]),
}

/// A set of markers.
#[derive(Clone, Copy, Debug)]
pub struct Dictionary {
    /// As the command line spells it, e.g. `aruco4x4_50`.
    pub name: &'static str,
    /// Cells in a row without the border, 4 - 6.
    pub side: u8,
    /// Wrong bits that can be put right, floor((least distance - 1) / 2), as OpenCV states it; 0 for the original dictionary, some of
    /// whose markers are nearly or quite the same when turned.
    pub correctable: u8,
    count: u16,
    codes: Codes,
}

macro_rules! dictionaries {
    ($($constant:ident $name:literal $side:literal $count:literal $correctable:literal $word:ident $table:ident;)*) => {
        impl Dictionary {
            $(
                #[doc = concat!("`", $name, "`: ", $count, " markers of ", $side, " x ", $side, " cells, ", $correctable, " wrong bits can be put right.")]
                pub const $constant: Dictionary = Dictionary {
                    name: $name,
                    side: $side,
                    correctable: $correctable,
                    count: $count,
                    codes: Codes::$word(&tables::$table),
                };
            )*
            /// Every dictionary.
            pub const ALL: &'static [Dictionary] = &[$(Dictionary::$constant),*];
        }
    };
}

dictionaries! {
    ARUCO_4X4_50 "aruco4x4_50" 4 50 1 U16 ARUCO_4X4;
    ARUCO_4X4_100 "aruco4x4_100" 4 100 1 U16 ARUCO_4X4;
    ARUCO_4X4_250 "aruco4x4_250" 4 250 1 U16 ARUCO_4X4;
    ARUCO_4X4_1000 "aruco4x4_1000" 4 1000 0 U16 ARUCO_4X4;
    ARUCO_5X5_50 "aruco5x5_50" 5 50 3 U32 ARUCO_5X5;
    ARUCO_5X5_100 "aruco5x5_100" 5 100 3 U32 ARUCO_5X5;
    ARUCO_5X5_250 "aruco5x5_250" 5 250 2 U32 ARUCO_5X5;
    ARUCO_5X5_1000 "aruco5x5_1000" 5 1000 2 U32 ARUCO_5X5;
    ARUCO_6X6_50 "aruco6x6_50" 6 50 6 U64 ARUCO_6X6;
    ARUCO_6X6_100 "aruco6x6_100" 6 100 5 U64 ARUCO_6X6;
    ARUCO_6X6_250 "aruco6x6_250" 6 250 5 U64 ARUCO_6X6;
    ARUCO_6X6_1000 "aruco6x6_1000" 6 1000 4 U64 ARUCO_6X6;
    ARUCO_ORIGINAL "aruco_original" 5 1024 0 U32 ARUCO_ORIGINAL;
    APRILTAG_36H11 "apriltag36h11" 6 587 5 U64 APRILTAG_36H11;
}

/// A pattern that was found in a dictionary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Match {
    /// The marker's number.
    pub id: u16,
    /// Quarter turns clockwise that bring the marker from upright to what was seen.
    pub turns: u8,
    /// Bits that differ.
    pub wrong: u8,
}

impl Dictionary {
    /// The dictionary of this name; `None` if there is none.
    pub fn by_name(name: &str) -> Option<Dictionary> {
        Dictionary::ALL.iter().copied().find(|dictionary| dictionary.name == name)
    }

    /// Number of markers; their numbers are 0 to this minus 1.
    pub const fn len(&self) -> usize {
        self.count as usize
    }

    /// Has it no marker? None of ours.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many bits a pattern holds beyond those that tell the markers and their four orientations apart: random cells are a marker
    /// once in 2 to the power of this.
    pub const fn bits_to_spare(&self) -> u32 {
        let bits = self.side as u32 * self.side as u32;
        bits - (4 * self.count as u32).ilog2()
    }

    /// Marker `id`'s pattern: `side * side` bits, white = 1, rows from the top, the first cell in the highest of them.
    /// `None` when there is no such marker.
    pub fn code(&self, id: usize) -> Option<u64> {
        (id < self.len()).then(|| match self.codes {
            Codes::U16(table) => table[id].into(),
            Codes::U32(table) => table[id].into(),
            Codes::U64(table) => table[id],
        })
    }

    /// Is the cell of a marker white? `column` and `row` count from the border's outer corner: 0 and `side + 1` are border.
    pub fn is_white(&self, code: u64, column: usize, row: usize) -> bool {
        let side = self.side as usize;
        let inside = 1..=side;
        inside.contains(&column)
            && inside.contains(&row)
            && code >> (side * side - 1 - ((row - 1) * side + column - 1)) & 1 == 1
    }

    /// The marker nearest to a pattern that was read, in any of four orientations: the one with the fewest wrong bits, of several
    /// the one with the lowest number. `None` when more than `tolerated` bits are wrong.
    ///
    /// Cost: 4 exclusive-ors and population counts a marker.
    pub fn nearest(&self, read: u64, tolerated: u8) -> Option<Match> {
        let side = self.side as usize;
        let mut seen = [read; 4];
        // Turning what was read counter-clockwise k times undoes k clockwise turns.
        for k in 1..4 {
            seen[k] = turned_back(seen[k - 1], side);
        }
        let mut best: Option<Match> = None;
        for id in 0..self.len() {
            let code = self.code(id)?;
            for (turns, pattern) in seen.iter().enumerate() {
                let wrong = (pattern ^ code).count_ones() as u8;
                if wrong <= tolerated && best.is_none_or(|best| wrong < best.wrong) {
                    best = Some(Match { id: id as u16, turns: turns as u8, wrong });
                }
            }
            if best.is_some_and(|best| best.wrong == 0) {
                break;
            }
        }
        best
    }
}

/// A pattern turned counter-clockwise by a quarter.
fn turned_back(code: u64, side: usize) -> u64 {
    let mut turned = 0;
    for row in 0..side {
        for column in 0..side {
            // What stands at (row, column) afterwards stood at column' = side - 1 - row, row' = column.
            let from = column * side + (side - 1 - row);
            turned = turned << 1 | code >> (side * side - 1 - from) & 1;
        }
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_of_a_square() {
        // 1 0      counter-clockwise: 0 0
        // 1 0                         1 1
        assert_eq!(turned_back(0b1010, 2), 0b0011);
        let code = 0x1_2345_6789;
        let once = turned_back(code, 6);
        assert_ne!(once, code);
        assert_eq!((0..4).fold(code, |code, _| turned_back(code, 6)), code);
    }

    #[test]
    fn every_marker_is_itself_with_as_many_wrong_bits_as_stated() {
        for dictionary in Dictionary::ALL {
            let bits = u32::from(dictionary.side).pow(2);
            for id in (0..dictionary.len()).step_by(7) {
                let mut code = dictionary.code(id).unwrap();
                assert!(bits == 64 || code >> bits == 0);
                for flip in 0..dictionary.correctable {
                    code ^= 1 << (u32::from(flip) * 5 % bits);
                }
                for turns in 0..4u8 {
                    let found = dictionary.nearest(code, dictionary.correctable).unwrap();
                    assert_eq!(usize::from(found.id), id, "{}", dictionary.name);
                    assert_eq!((found.turns, found.wrong), (turns, dictionary.correctable));
                    // Clockwise once = counter-clockwise three times.
                    code = (0..3).fold(code, |code, _| turned_back(code, dictionary.side.into()));
                }
            }
            assert_eq!(dictionary.code(dictionary.len()), None);
        }
    }

    #[test]
    fn the_pattern_in_the_documentation() {
        let dictionary = Dictionary::by_name("aruco4x4_50").unwrap();
        assert_eq!(dictionary.code(0), Some(0b1011_0101_0011_0010));
        let white = |column, row| dictionary.is_white(0xb532, column, row);
        assert!(white(1, 1) && !white(2, 1) && white(4, 2) && !white(4, 4));
        assert!(!white(0, 1) && !white(5, 5));
    }
}
