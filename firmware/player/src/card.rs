//! A card and its files: what may fail is tried again and told, and the volume may be in a partition or bare.
//!
//! ```text
//!  Files: paths, long names, sub-directories       embedded-sdmmc's VolumeManager
//!    |                                                |
//!  Careful: tries again, remembers what failed and what was read
//!    |      a bare volume gets a partition table in front: block 0 is made up, block n is the card's n - 1
//!  Card: an SD card in SPI mode, or a test's memory
//! ```
//!
//! FAT32 and FAT16, blocks of 512 bytes. Names match without regard to the case of ASCII letters.

use core::cell::{Cell, RefCell};
use core::ops::ControlFlow;

use embedded_sdmmc::filesystem::ToShortFileName;
use embedded_sdmmc::{
    Block, BlockCount, BlockDevice, BlockIdx, ClusterId, Directory, Error, LfnBuffer, Mode,
    RawVolume, ShortFileName, TimeSource, Timestamp, VolumeIdx, VolumeManager,
};

use crate::fault::{CardFault, Failed, Fault, Faults, FileFault};

/// How often a sector is asked for before its failure is told.
pub const TRIES: u32 = 3;
/// Bytes handed on at once: a sector.
pub const CHUNK: usize = 512;
/// Longest name of a file or folder in bytes of UTF-8.
const LONG_NAME: usize = 256;

/// Entries that a folder may have.
const MOST_ENTRIES: u32 = 65_536;

/// A card that can be started anew.
pub trait Card: BlockDevice {
    /// Starts the card, whatever happened before: slowly, then fast.
    ///
    /// # Errors
    /// What it says, or that it says nothing.
    fn start(&self) -> Result<(), Self::Error>;

    /// What an error means.
    fn fault(error: &Self::Error) -> CardFault;
}

/// Takes the bytes of a file; breaks off when it has enough.
pub type Sink<'s> = &'s mut dyn FnMut(&[u8]) -> Result<ControlFlow<()>, Failed>;

/// What reading cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Bytes of files handed on.
    pub bytes: u32,
    /// Sectors read, repeated ones counted again.
    pub sectors: u32,
    /// Sectors that were asked for again.
    pub repeated: u32,
}

/// A card that is tried again.
struct Careful<'c, C> {
    card: &'c C,
    /// Sectors that a bare volume has; `None` for a partitioned card.
    bare: Option<u32>,
    cost: &'c Cell<Cost>,
    faults: &'c Faults,
    /// First sector of the volume's data; before it lie the tables of clusters.
    data: u32,
    /// The last sector of the tables that was read: embedded-sdmmc looks a cluster up for each sector of small clusters and keeps one
    /// sector at a time, so it would ask for the same one again and again.
    table: RefCell<Option<(u32, Block)>>,
}

impl<C: Card> Careful<'_, C> {
    /// A sector, from memory where it is the table's last one.
    fn fetch_or_keep(&self, block: &mut Block, sector: u32) -> Result<(), C::Error> {
        if sector >= self.data {
            return self.fetch(block, sector);
        }
        let mut table = self.table.borrow_mut();
        if let Some((_, kept)) = table.as_ref().filter(|(kept, _)| *kept == sector) {
            block.clone_from(kept);
            return Ok(());
        }
        self.fetch(block, sector)?;
        *table = Some((sector, block.clone()));
        Ok(())
    }

    fn fetch(&self, block: &mut Block, sector: u32) -> Result<(), C::Error> {
        let mut tries = 0;
        loop {
            tries += 1;
            let mut cost = self.cost.get();
            cost.sectors += 1;
            cost.repeated += u32::from(tries > 1);
            self.cost.set(cost);
            match self.card.read(core::slice::from_mut(block), BlockIdx(sector)) {
                Ok(()) => return Ok(()),
                Err(error) => {
                    let fault = C::fault(&error);
                    // Only a wrong checksum may come right; a card that is gone costs a tenth of a second a try.
                    if fault != CardFault::Checksum || tries == TRIES {
                        self.faults.leave(Fault::Card { fault, sector, tries });
                        return Err(error);
                    }
                }
            }
        }
    }
}

impl<C: Card> BlockDevice for Careful<'_, C> {
    type Error = C::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), C::Error> {
        for (block, index) in blocks.iter_mut().zip(start.0..) {
            match self.bare {
                Some(sectors) if index == 0 => *block = partition_table(sectors),
                Some(_) => self.fetch_or_keep(block, index - 1)?,
                None => self.fetch_or_keep(block, index)?,
            }
        }
        Ok(())
    }

    fn write(&self, _blocks: &[Block], _start: BlockIdx) -> Result<(), C::Error> {
        // Files are opened for reading only.
        Ok(())
    }

    fn num_blocks(&self) -> Result<BlockCount, C::Error> {
        self.card.num_blocks()
    }
}

/// A partition table with one FAT32 partition from sector 1 on.
fn partition_table(sectors: u32) -> Block {
    let mut block = Block::new();
    block[450] = 0x0c;
    block[454] = 1;
    block[458..462].copy_from_slice(&sectors.to_le_bytes());
    block[510..].copy_from_slice(&[0x55, 0xaa]);
    block
}

#[inline(never)]
fn two(block: &Block, at: usize) -> u32 {
    u32::from(block[at]) | u32::from(block[at + 1]) << 8
}

fn four(block: &Block, at: usize) -> u32 {
    two(block, at) | two(block, at + 2) << 16
}

/// The number of clusters of a volume, from its boot sector, which must make sense: embedded-sdmmc computes with it.
#[inline(never)]
fn clusters(block: &Block) -> Option<u32> {
    let either = |short, long| if short != 0 { short } else { long };
    let total = either(two(block, 19), four(block, 32));
    let fat = either(two(block, 22), four(block, 36));
    let (per_cluster, reserved, fats) =
        (u32::from(block[13]), two(block, 14), u32::from(block[16]));
    let root = (two(block, 17) * 32).div_ceil(Block::LEN_U32);
    let used = fat.checked_mul(fats).and_then(|fats| fats.checked_add(reserved + root));
    let sound = two(block, 510) == 0xaa55
        && two(block, 11) == Block::LEN_U32
        && per_cluster.is_power_of_two()
        && reserved > 0
        && matches!(fats, 1 | 2);
    let data = used.and_then(|used| total.checked_sub(used)).filter(|_| sound);
    // Where FAT32's root folder begins; FAT16's has a place of its own.
    let first = if two(block, 22) == 0 { four(block, 44) } else { 2 };
    let clusters = data? / per_cluster;
    // A table of 32 bits names at most 2^28 clusters and must be as long as the clusters are many.
    let known = (1..0x0fff_fff0).contains(&clusters) && clusters <= fat.saturating_mul(256);
    (known && (2..clusters + 2).contains(&first)).then_some(clusters)
}

/// Sectors of a volume before its root folder or its data: reserved ones and tables. Its boot sector makes sense.
fn before_data(block: &Block) -> u32 {
    let fat = if two(block, 22) != 0 { two(block, 22) } else { four(block, 36) };
    fat.saturating_mul(block[16].into()).saturating_add(two(block, 14))
}

/// What sector 0 is.
enum Sector0 {
    /// A volume of so many sectors.
    Bare(u32),
    /// A partition table; which of its entries, and where that begins.
    Partition { index: usize, first: u32 },
}

#[inline(never)]
fn examine(block: &Block) -> Result<Sector0, &'static str> {
    if two(block, 510) != 0xaa55 {
        return Err("sector 0 has no signature");
    }
    // A volume's boot sector begins with a jump and says how large sectors are; code of a partition table's does not.
    if matches!(block[0], 0xeb | 0xe9) && two(block, 11) == Block::LEN_U32 && block[16] != 0 {
        let short = two(block, 19);
        return Ok(Sector0::Bare(if short != 0 { short } else { four(block, 32) }));
    }
    if &block[3..11] == b"EXFAT   " {
        return Err("the volume is exFAT");
    }
    let kinds = [0, 1, 2, 3].map(|i| block[450 + 16 * i]);
    match kinds.iter().position(|kind| matches!(kind, 0x0b | 0x0c | 0x04 | 0x06 | 0x0e)) {
        Some(index) => Ok(Sector0::Partition { index, first: four(block, 454 + 16 * index) }),
        None if kinds.contains(&0xee) => Err("it has a GPT"),
        None if kinds.contains(&0x07) => Err("a partition is exFAT or NTFS"),
        None => Err("no partition is FAT"),
    }
}

/// The card has no clock.
struct NoTime;

impl TimeSource for NoTime {
    fn get_timestamp(&self) -> Timestamp {
        Timestamp {
            year_since_1970: 0,
            zero_indexed_month: 0,
            zero_indexed_day: 0,
            hours: 0,
            minutes: 0,
            seconds: 0,
        }
    }
}

/// Files that may be read: `show.txt`, the model, the texture. They and the volume are never closed, since closing is what writes:
/// the manager is dropped as it is, and 2 KB of embedded-sdmmc aren't linked.
const MOST_FILES: usize = 3;

type Manager<'c, C> = VolumeManager<Careful<'c, C>, NoTime, 3, MOST_FILES, 1>;
type Folder<'f, 'c, C> = Directory<'f, Careful<'c, C>, NoTime, 3, MOST_FILES, 1>;

/// Starts a card, opens its first FAT volume, and lends its files to `with`.
///
/// # Errors
/// The card's, the volume's, or what `with` says, left in `faults`.
#[inline(never)]
pub fn with_files<C: Card, R>(
    card: &C,
    cost: &Cell<Cost>,
    faults: &Faults,
    with: impl FnOnce(&Files<'_, '_, C>) -> Result<R, Failed>,
) -> Result<R, Failed> {
    card.start().map_err(|error| {
        let fault = match C::fault(&error) {
            CardFault::Gone => CardFault::Missing,
            fault => fault,
        };
        faults.leave(Fault::Card { fault, sector: 0, tries: 1 })
    })?;
    let table = RefCell::new(None);
    let mut careful = Careful { card, bare: None, cost, faults, data: 0, table };
    let mut block = Block::new();
    careful.fetch(&mut block, 0).map_err(|_| Failed)?;
    let format = |what| faults.leave(Fault::Format(what));
    let (partition, first) = match examine(&block).map_err(format)? {
        Sector0::Bare(sectors) => {
            careful.bare = Some(sectors);
            (0, 0)
        }
        Sector0::Partition { index, first } => {
            careful.fetch(&mut block, first).map_err(|_| Failed)?;
            (index, first)
        }
    };
    let clusters = clusters(&block).ok_or_else(|| format("its boot sector makes no sense"))?;
    careful.data = first.saturating_add(before_data(&block));
    let manager: Manager<'_, C> = VolumeManager::new_with_limits(careful, NoTime, 0);
    let volume = manager.open_raw_volume(VolumeIdx(partition));
    let volume = volume.map_err(|error| left(error, faults, ""))?;
    with(&Files { manager: &manager, volume, faults, cost, clusters })
}

/// Leaves an error of the file system in words, unless the card's own fault is there, which was its cause.
#[inline(never)]
fn left<E: core::error::Error>(error: Error<E>, faults: &Faults, path: &str) -> Failed {
    let what = match error {
        Error::NotFound | Error::FilenameError(_) => {
            return faults.leave_file(path, FileFault::Missing);
        }
        Error::OpenedDirAsFile | Error::OpenedFileAsDir => {
            return faults.leave_file(path, FileFault::Kind);
        }
        Error::FileAlreadyOpen => return faults.leave_file(path, FileFault::Twice),
        Error::FormatError(what) => return faults.leave(Fault::Format(what)),
        Error::UnterminatedFatChain => "a chain of clusters has no end",
        Error::BadCluster => "a bad cluster",
        Error::EndOfFile => "a file is shorter than it says",
        _ => "it contradicts itself",
    };
    faults.leave(Fault::Damaged(what))
}

/// The files of a volume.
pub struct Files<'f, 'c, C: Card> {
    manager: &'f Manager<'c, C>,
    volume: RawVolume,
    /// Where faults are left.
    pub faults: &'c Faults,
    cost: &'c Cell<Cost>,
    clusters: u32,
}

impl<C: Card> Files<'_, '_, C> {
    /// Reads a file from its beginning, a sector at most at a time, until its end or until `sink` breaks off.
    ///
    /// # Errors
    /// The card's and the file system's; `sink`'s; [`FileFault::Empty`] for a file without a byte, [`FileFault::Twice`] for one that
    /// was read before.
    #[inline(never)]
    pub fn read(&self, path: &str, sink: Sink<'_>) -> Result<(), Failed> {
        let left = |error| left(error, self.faults, path);
        let root = self.manager.open_root_dir(self.volume).map_err(left)?;
        let mut folder: Folder<'_, '_, C> = root.to_directory(self.manager);
        let (mut part, mut rest) = first_name(path);
        let file = loop {
            let short = self.find(&folder, part, path)?;
            if rest.is_empty() {
                break folder.open_file_in_dir(short, Mode::ReadOnly).map_err(left)?.to_raw_file();
            }
            folder.change_dir(short).map_err(left)?;
            (part, rest) = first_name(rest);
        };
        let (mut chunk, mut bytes) = ([0; CHUNK], 0);
        loop {
            let length = self.manager.read(file, &mut chunk).map_err(left)?;
            bytes += length as u32;
            if bytes == 0 {
                return Err(self.faults.leave_file(path, FileFault::Empty));
            }
            if length == 0 || sink(&chunk[..length])?.is_break() {
                let mut cost = self.cost.get();
                cost.bytes += bytes;
                self.cost.set(cost);
                return Ok(());
            }
        }
    }

    /// The short name of an entry, found by its long or its short one.
    #[inline(never)]
    fn find(
        &self,
        folder: &Folder<'_, '_, C>,
        part: &str,
        path: &str,
    ) -> Result<ShortFileName, Failed> {
        let mut storage = [0; LONG_NAME];
        let mut long = LfnBuffer::new(&mut storage);
        let short = part.to_short_filename().ok();
        let (mut found, mut outside, mut entries) = (None, false, 0u32);
        folder
            .iterate_dir_lfn(&mut long, |entry, long| {
                let hit = long.is_some_and(|long| long.eq_ignore_ascii_case(part))
                    || short.as_ref() == Some(&entry.name);
                if hit && !entry.attributes.is_volume() {
                    found = Some(entry.name);
                    // Clusters count from 2; 0 is that of an empty file.
                    outside = entry.cluster >= ClusterId::EMPTY + (self.clusters + 2);
                    return ControlFlow::Break(());
                }
                // A chain of clusters may bite its own tail.
                entries += 1;
                if entries > MOST_ENTRIES {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })
            .map_err(|error| left(error, self.faults, path))?;
        if entries > MOST_ENTRIES {
            return Err(self.faults.leave(Fault::Damaged("a folder has no end")));
        }
        if outside {
            return Err(self.faults.leave(Fault::Damaged("a file begins outside the volume")));
        }
        found.ok_or_else(|| self.faults.leave_file(path, FileFault::Missing))
    }
}

/// The first name of a path, and what follows the slashes after it.
fn first_name(path: &str) -> (&str, &str) {
    let path = without_slashes(path);
    let end = path.bytes().position(|byte| byte == b'/').unwrap_or(path.len());
    let (name, rest) = path.split_at_checked(end).unwrap_or((path, ""));
    (name, without_slashes(rest))
}

#[inline(never)]
fn without_slashes(mut path: &str) -> &str {
    while let Some(rest) = path.strip_prefix('/') {
        path = rest;
    }
    path
}
