//! Analysed objects and supporters, kept for the pairs that need them again.

use super::super::input;
use super::super::predict::warning_of_centre_of_mass;
use super::super::source::Source;
use super::pairs::Pair;
use anyhow::Result;
use hangpose::geometry::Cloud;
use hangpose::hanging::{Object, Supporter};
use hangpose::memory::Limits;
use hangpose::{CentreOfMass, Monitor, Params};
use self_cell::{MutBorrow, self_cell};
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

self_cell!(
    /// An object with its memory.
    struct ObjectCell {
        owner: MutBorrow<Vec<u8>>,
        #[covariant]
        dependent: Object,
    }
);

self_cell!(
    /// A supporter with its memory.
    struct SupporterCell {
        owner: MutBorrow<Vec<u8>>,
        #[covariant]
        dependent: Supporter,
    }
);

/// What a pair has one of on either side.
pub(super) trait Model: Sized {
    /// What makes two models the same: the file, and all options that the analysis depends on.
    fn key(pair: &Pair) -> String;
    /// Reads and analyses it.
    fn read(pair: &Pair) -> Result<Self>;
    /// Memory that it takes.
    fn bytes(&self) -> usize;
}

/// An analysed object.
pub(super) struct ObjectModel {
    cell: ObjectCell,
    bytes: usize,
    /// What is odd about its size or its centre of mass.
    pub(super) warnings: Vec<String>,
}

impl ObjectModel {
    pub(super) fn object(&self) -> &Object<'_> {
        self.cell.borrow_dependent()
    }
}

impl Model for ObjectModel {
    fn key(pair: &Pair) -> String {
        let (frames, params) = (&pair.wish.options.frames, &pair.wish.params);
        let placed = (frames.object_scale, frames.object_up, &frames.object_viewpoint);
        format!("{} {placed:?} {params:?}", pair.object_path.display())
    }

    fn read(pair: &Pair) -> Result<Self> {
        let (frames, params) = (&pair.wish.options.frames, &pair.wish.params);
        let placed = Source::File(&pair.object_path).object(frames)?;
        let mesh = placed.shape.mesh()?;
        let com = warning_of_centre_of_mass(&mesh, frames.com).map(String::from);
        let bytes = Object::bytes(&Object::limits(&mesh, params));
        let cell = ObjectCell::try_new(MutBorrow::new(vec![0; bytes]), |memory| {
            Object::analyze(&mesh, params, memory.borrow_mut(), &Monitor::new())
        })?;
        Ok(Self { cell, bytes, warnings: placed.scale_warning.into_iter().chain(com).collect() })
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

/// An analysed supporter.
pub(super) struct SupporterModel {
    cell: SupporterCell,
    bytes: usize,
    /// Where its coordinates begin in those of its file, metres.
    pub(super) origin: [f64; 3],
    /// What is odd about its size.
    pub(super) warnings: Vec<String>,
}

impl SupporterModel {
    pub(super) fn supporter(&self) -> &Supporter<'_> {
        self.cell.borrow_dependent()
    }

    /// The constants of a pair without the object's centre of mass, on which no supporter depends.
    fn params(pair: &Pair) -> Params {
        Params { centre_of_mass: CentreOfMass::Volume, ..pair.wish.params.clone() }
    }
}

impl Model for SupporterModel {
    fn key(pair: &Pair) -> String {
        let (frames, cloud) = (&pair.wish.options.frames, &pair.wish.options.cloud);
        let placed = (frames.supporter_scale, frames.supporter_up);
        let seen = (cloud.supporter_points, &cloud.viewpoint, cloud.region);
        format!("{} {placed:?} {seen:?} {:?}", pair.supporter_path.display(), Self::params(pair))
    }

    fn read(pair: &Pair) -> Result<Self> {
        let (options, params) = (&pair.wish.options, &Self::params(pair));
        let source = Source::File(&pair.supporter_path);
        let placed = source.supporter(&options.frames, &options.cloud, params.seed)?;
        let cloud: Cloud = input::seen(&placed.shape, &options.cloud)?;
        let bytes = Supporter::bytes(&Limits::of_points(cloud.points().len()));
        let cell = SupporterCell::try_new(MutBorrow::new(vec![0; bytes]), |memory| {
            Supporter::analyze(&cloud, params, memory.borrow_mut(), &Monitor::new())
        })?;
        input::tell_of_cloud(source.name(), cell.borrow_dependent(), &cloud);
        let warnings = placed.scale_warning.into_iter().collect();
        Ok(Self { cell, bytes, origin: placed.shape.origin, warnings })
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

/// A model, or the reason why there is none; empty until it is first needed.
type Slot<T> = Arc<OnceLock<Result<T, String>>>;

/// A file that pairs need.
struct Entry<T> {
    slot: Slot<T>,
    /// The pairs that have yet to use it.
    uses: BTreeSet<u64>,
}

/// The models that pairs still need, in limited memory.
///
/// A model is read when the first pair needs it and dropped when no pair does any more. If the models take more memory
/// than they may, those that are needed last are dropped and read again.
pub(super) struct Store<T> {
    entries: Mutex<HashMap<String, Entry<T>>>,
    /// Memory that the models may take while no pair uses them, bytes.
    capacity: usize,
}

impl<T: Model> Store<T> {
    /// A store for these pairs.
    pub(super) fn new<'p>(pairs: impl Iterator<Item = &'p Pair>, capacity: usize) -> Self {
        let mut entries: HashMap<String, Entry<T>> = HashMap::new();
        for pair in pairs {
            let entry = entries
                .entry(T::key(pair))
                .or_insert_with(|| Entry { slot: Slot::default(), uses: BTreeSet::new() });
            entry.uses.insert(pair.name.number);
        }
        Self { entries: Mutex::new(entries), capacity }
    }

    /// The model that a pair needs. While one thread reads it, others that need it wait.
    pub(super) fn get(&self, pair: &Pair) -> Slot<T> {
        let slot = {
            let entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
            entries.get(&T::key(pair)).map(|entry| entry.slot.clone()).unwrap_or_default()
        };
        slot.get_or_init(|| T::read(pair).map_err(|error| format!("{error:#}")));
        slot
    }

    /// Drops the models that are not needed once a pair is done, and those that are needed last if they are too large.
    pub(super) fn release(&self, pair: &Pair) {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let key = T::key(pair);
        if let Some(entry) = entries.get_mut(&key) {
            entry.uses.remove(&pair.name.number);
            if entry.uses.is_empty() {
                entries.remove(&key);
            }
        }
        let size = |entry: &Entry<T>| match entry.slot.get() {
            Some(Ok(model)) => model.bytes(),
            _ => 0,
        };
        let mut total: usize = entries.values().map(size).sum();
        while total > self.capacity {
            let idle =
                entries.values_mut().filter(|entry| size(entry) > 0 && Arc::strong_count(&entry.slot) == 1);
            let Some(last) = idle.max_by_key(|entry| entry.uses.first().copied()) else { break };
            total -= size(last);
            last.slot = Slot::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::Given;
    use super::super::pairs;
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    static READ: AtomicUsize = AtomicUsize::new(0);

    /// A model of ten bytes whose key is the name of the object.
    struct Ten;

    impl Model for Ten {
        fn key(pair: &Pair) -> String {
            pair.name.object.clone()
        }

        fn read(_: &Pair) -> Result<Self> {
            READ.fetch_add(1, Ordering::Relaxed);
            Ok(Self)
        }

        fn bytes(&self) -> usize {
            10
        }
    }

    /// How often the models of pairs are read, in a store of that capacity, and how many are left at the end.
    fn reads(objects: &str, capacity: usize) -> (usize, usize) {
        let table = objects
            .chars()
            .fold(String::from("object,supporter\n"), |all, name| all + &format!("{name},s\n"));
        let pairs = pairs::read("pairs.csv".as_ref(), table.as_bytes(), &Given::default()).unwrap();
        let store = Store::<Ten>::new(pairs.iter(), capacity);
        READ.store(0, Ordering::Relaxed);
        for pair in &pairs {
            drop(store.get(pair));
            store.release(pair);
            let entries = store.entries.lock().unwrap();
            let kept = entries.values().filter(|entry| entry.slot.get().is_some()).count();
            assert!(10 * kept <= capacity.max(10));
        }
        (READ.load(Ordering::Relaxed), store.entries.lock().unwrap().len())
    }

    #[test]
    fn models_are_read_once_if_there_is_room_and_those_needed_last_are_dropped() {
        assert_eq!(reads("abcabcabc", 30), (3, 0));
        // With room for two of three: a, b, then c is needed last and dropped, a, b again, c, ... as Belady's rule has it.
        assert_eq!(reads("abcabc", 20), (4, 0));
        assert_eq!(reads("abab", 0), (4, 0));
        // What no pair needs again makes room at once.
        assert_eq!(reads("aabbcc", 10), (3, 0));
    }
}
