//! Models in the caller's memory: a [`Handle`] at the front, and behind it what the core built the model of.

use crate::border::{Region, memory};
use crate::failure::Failure;
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

/// What a handle can hold.
pub(crate) trait Model: Copy {
    /// The word that a handle of this kind begins with.
    const MAGIC: u32;
    /// What the header calls a pointer to it.
    const ARGUMENT: &'static str;
    /// The function that makes it.
    const MAKER: &'static str;
}

/// What an opaque pointer in C leads to.
#[repr(C)]
pub(crate) struct Handle<M> {
    /// [`Model::MAGIC`]: tells a handle from memory that was never written, or has been since.
    magic: u32,
    /// How many calls read the model at this moment, or [`BUILDING`] or [`EMPTY`].
    users: AtomicU32,
    /// Where the handle was made: a copy elsewhere still points into the original's memory, and is refused.
    address: usize,
    /// What is behind the handle.
    arena: *mut u8,
    arena_size: usize,
    /// Written while `users` is `BUILDING`, read while it counts readers.
    model: UnsafeCell<MaybeUninit<M>>,
}

const BUILDING: u32 = u32::MAX;
const EMPTY: u32 = u32::MAX - 1;
const MOST_USERS: u32 = u32::MAX - 2;

impl<M: Model> Handle<M> {
    /// Bytes that a handle takes in front of its model, wherever the memory begins.
    pub(crate) const BYTES: usize = size_of::<Self>() + align_of::<Self>() - 1;

    /// Makes a handle at the front of `size` bytes at `pointer`, and its model, of `needed` bytes, behind.
    ///
    /// # Safety
    ///
    /// As [`memory`]'s, and no call uses a handle that was in this memory before.
    pub(crate) unsafe fn create(
        pointer: *mut u8,
        size: usize,
        needed: usize,
        build: impl FnOnce(&'static mut [u8]) -> Result<M, Failure>,
    ) -> Result<*mut Self, Failure> {
        let needed = needed.saturating_add(Self::BYTES);
        if size < needed {
            return Err(Failure::Memory { argument: "memory", needed, given: size });
        }
        // SAFETY: as this function's.
        let all = unsafe { memory(pointer, size) }?;
        let skip = all.as_ptr().align_offset(align_of::<Self>());
        let (front, arena) = all[skip..].split_at_mut(size_of::<Self>());
        let handle = front.as_mut_ptr().cast::<Self>();
        let (arena, arena_size) = (arena.as_mut_ptr(), arena.len());
        let address = handle.addr();
        let model = UnsafeCell::new(MaybeUninit::uninit());
        // SAFETY: `front` is aligned, of the right size, and no one else's. The magic comes last, when there is a
        // model: a handle that was here before is no more.
        unsafe {
            handle.write(Self { magic: 0, users: AtomicU32::new(0), address, arena, arena_size, model })
        };
        // SAFETY: the arena is a part of `all` that nothing refers to, and no one touches it as long as the handle is
        // in use, which is all the life that the model gets.
        let model = build(unsafe { core::slice::from_raw_parts_mut(arena, arena_size) })?;
        // SAFETY: the handle was written above.
        unsafe {
            (&mut *(*handle).model.get()).write(model);
            (*handle).magic = M::MAGIC;
        }
        Ok(handle)
    }

    /// The handle behind an opaque pointer.
    ///
    /// # Safety
    ///
    /// The pointer is null or leads to as many bytes as a handle has.
    unsafe fn from_pointer<'a>(pointer: *const Self) -> Result<&'a Self, Failure> {
        let argument = M::ARGUMENT;
        if pointer.is_null() {
            return Err(Failure::Null { argument });
        }
        // SAFETY: aligned, and readable as the caller vouches. Only numbers are read, until it is known to be a handle.
        let is_handle = pointer.is_aligned()
            && unsafe { (&raw const (*pointer).magic).read() } == M::MAGIC
            && unsafe { (&raw const (*pointer).address).read() } == pointer.addr();
        if !is_handle {
            return Err(Failure::Handle { argument, maker: M::MAKER });
        }
        // SAFETY: `create` was here and nothing has written over it since.
        Ok(unsafe { &*pointer })
    }

    /// The model, for as long as the guard is there. Any number of threads may have it at once.
    ///
    /// # Safety
    ///
    /// As [`Self::from_pointer`]'s, and no one overwrites the handle's memory until the guard is gone.
    pub(crate) unsafe fn share<'a>(pointer: *const Self) -> Result<Shared<'a, M>, Failure> {
        // SAFETY: as this function's.
        let handle = unsafe { Self::from_pointer(pointer) }?;
        let mut users = handle.users.load(Ordering::Relaxed);
        loop {
            match users {
                EMPTY => return Err(Failure::Empty { argument: M::ARGUMENT }),
                BUILDING | MOST_USERS => return Err(Failure::Busy { argument: M::ARGUMENT }),
                _ => {}
            }
            let more =
                handle.users.compare_exchange_weak(users, users + 1, Ordering::Acquire, Ordering::Relaxed);
            match more {
                Ok(_) => return Ok(Shared { handle }),
                Err(now) => users = now,
            }
        }
    }

    /// Builds the model anew in the same memory. `check` looks whether it can be built in so many bytes; if not, the
    /// old one stays. If `build` then fails, the handle is empty.
    ///
    /// # Safety
    ///
    /// As [`Self::share`]'s.
    pub(crate) unsafe fn rebuild(
        pointer: *const Self,
        check: impl FnOnce(usize, [Region; 2]) -> Result<(), Failure>,
        build: impl FnOnce(&'static mut [u8]) -> Result<M, Failure>,
    ) -> Result<(), Failure> {
        // SAFETY: as this function's.
        let handle = unsafe { Self::from_pointer(pointer) }?;
        let claim =
            |from| handle.users.compare_exchange(from, BUILDING, Ordering::Acquire, Ordering::Relaxed);
        let before = match claim(0).or_else(|_| claim(EMPTY)) {
            Ok(before) => before,
            Err(_) => return Err(Failure::Busy { argument: M::ARGUMENT }),
        };
        if let Err(failure) = check(handle.arena_size, handle.written_regions()) {
            handle.users.store(before, Ordering::Release);
            return Err(failure);
        }
        // SAFETY: the arena was split off in `create` and nothing but the old model refers to it, which no one reads:
        // there are no users, and there will be none before the next line but one.
        let built = build(unsafe { core::slice::from_raw_parts_mut(handle.arena, handle.arena_size) });
        let after = if built.is_ok() { 0 } else { EMPTY };
        let result = built.map(|model| {
            // SAFETY: no one else has the model while it is being built.
            unsafe { (*handle.model.get()).write(model) };
        });
        handle.users.store(after, Ordering::Release);
        result
    }

    fn regions(&self) -> [Region; 2] {
        [Region::read(M::ARGUMENT, self, 1), Region::read(M::ARGUMENT, self.arena, self.arena_size)]
    }

    fn written_regions(&self) -> [Region; 2] {
        [Region::written(M::ARGUMENT, self, 1), Region::written(M::ARGUMENT, self.arena, self.arena_size)]
    }
}

/// A model in use.
pub(crate) struct Shared<'a, M: Model> {
    handle: &'a Handle<M>,
}

impl<M: Model> Shared<'_, M> {
    pub(crate) fn model(&self) -> &M {
        // SAFETY: a handle with users has a model, and no one writes to it as long as it has users.
        unsafe { (*self.handle.model.get()).assume_init_ref() }
    }

    /// What the model occupies, as far as this is known: all the memory but a few bytes in front of the handle.
    pub(crate) fn regions(&self) -> [Region; 2] {
        self.handle.regions()
    }
}

impl<M: Model> Drop for Shared<'_, M> {
    fn drop(&mut self) {
        self.handle.users.fetch_sub(1, Ordering::Release);
    }
}
