//! Models in the caller's memory: a [`Handle`] at the front, and behind it the memory in which the core built the
//! model.

use crate::border::{Region, memory};
use crate::failure::Failure;
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

/// A type that a handle can hold.
pub(crate) trait Model {
    /// First word of a handle of this kind.
    const MAGIC: u32;
    /// Name of the argument in the header.
    const ARGUMENT: &'static str;
    /// Name of the function that creates it.
    const MAKER: &'static str;
}

/// The target of an opaque pointer in C.
#[repr(C)]
pub(crate) struct Handle<M> {
    /// [`Model::MAGIC`]: distinguishes a handle from memory that was never written or was overwritten.
    magic: u32,
    /// Number of calls that read the model at the moment, or [`BUILDING`] or [`EMPTY`].
    users: AtomicU32,
    /// Address at which the handle was created. A copy at another address would still point into the memory of the
    /// original, so it is refused.
    address: usize,
    /// Memory behind the handle.
    arena: *mut u8,
    arena_size: usize,
    /// Written while `users` is `BUILDING`, read while `users` counts readers.
    model: UnsafeCell<MaybeUninit<M>>,
}

const BUILDING: u32 = u32::MAX;
const EMPTY: u32 = u32::MAX - 1;
const MOST_USERS: u32 = u32::MAX - 2;

impl<M: Model> Handle<M> {
    /// Bytes for a handle in front of its model, in memory that begins at any address.
    pub(crate) const BYTES: usize = size_of::<Self>() + align_of::<Self>() - 1;

    /// Creates a handle at the front of the `size` bytes at `pointer`, and behind it its model of `needed` bytes.
    ///
    /// # Safety
    ///
    /// Those of [`memory`], and no call uses a handle that was in this memory before.
    pub(crate) unsafe fn create<R: From<Failure>>(
        pointer: *mut u8,
        size: usize,
        needed: usize,
        build: impl FnOnce(&'static mut [u8]) -> Result<M, R>,
    ) -> Result<*mut Self, R> {
        // Memory that is reused or given back ends a model without a destructor.
        const { assert!(!core::mem::needs_drop::<M>()) };
        let needed = needed.saturating_add(Self::BYTES);
        if size < needed {
            return Err(Failure::Memory { argument: "memory", needed, given: size }.into());
        }
        // SAFETY: those of this function.
        let all = unsafe { memory(pointer, size) }?;
        let skip = all.as_ptr().align_offset(align_of::<Self>());
        let (front, arena) = all[skip..].split_at_mut(size_of::<Self>());
        let handle = front.as_mut_ptr().cast::<Self>();
        let (arena, arena_size) = (arena.as_mut_ptr(), arena.len());
        let address = handle.addr();
        let model = UnsafeCell::new(MaybeUninit::uninit());
        // SAFETY: `front` is aligned, of the right size, and nobody else uses it. The magic is written last, when there
        // is a model. Until then a handle that was here before is invalid.
        unsafe {
            handle.write(Self { magic: 0, users: AtomicU32::new(0), address, arena, arena_size, model })
        };
        // SAFETY: the arena is a part of `all` to which nothing refers, and nobody touches it while the handle is in
        // use. The model lives no longer than that.
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
    /// The pointer is null or leads to as many readable bytes as a handle has.
    unsafe fn from_pointer<'a>(pointer: *const Self) -> Result<&'a Self, Failure> {
        let argument = M::ARGUMENT;
        if pointer.is_null() {
            return Err(Failure::Null { argument });
        }
        // SAFETY: aligned, and the caller vouches that it is readable. Only numbers are read until it is known to be a
        // handle.
        let is_handle = pointer.is_aligned()
            && unsafe { (&raw const (*pointer).magic).read() } == M::MAGIC
            && unsafe { (&raw const (*pointer).address).read() } == pointer.addr();
        if !is_handle {
            return Err(Failure::Handle { argument, maker: M::MAKER });
        }
        // SAFETY: `create` wrote the handle and nothing has overwritten it since.
        Ok(unsafe { &*pointer })
    }

    /// The model, as long as the guard exists. Any number of threads may share it.
    ///
    /// # Safety
    ///
    /// Those of [`Self::from_pointer`], and nobody overwrites the memory of the handle while the guard exists.
    pub(crate) unsafe fn share<'a>(pointer: *const Self) -> Result<Shared<'a, M>, Failure> {
        // SAFETY: those of this function.
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

    /// The model for one call alone, as long as the guard exists.
    ///
    /// # Safety
    ///
    /// Those of [`Self::share`].
    pub(crate) unsafe fn claim<'a>(pointer: *const Self) -> Result<Claimed<'a, M>, Failure> {
        // SAFETY: those of this function.
        let handle = unsafe { Self::from_pointer(pointer) }?;
        match handle.users.compare_exchange(0, BUILDING, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => Ok(Claimed { handle }),
            Err(EMPTY) => Err(Failure::Empty { argument: M::ARGUMENT }),
            Err(_) => Err(Failure::Busy { argument: M::ARGUMENT }),
        }
    }

    /// Builds the model again in the same memory. If `check` finds that the new model cannot be built in the given
    /// number of bytes, the old model stays. If `build` then fails, the handle is empty.
    ///
    /// # Safety
    ///
    /// Those of [`Self::share`].
    pub(crate) unsafe fn rebuild(
        pointer: *const Self,
        check: impl FnOnce(usize, [Region; 2]) -> Result<(), Failure>,
        build: impl FnOnce(&'static mut [u8]) -> Result<M, Failure>,
    ) -> Result<(), Failure> {
        // SAFETY: those of this function.
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
        // SAFETY: the arena was split off in `create`, and only the old model refers to it. Nobody reads that model:
        // there are no users, and there can be none until `users` is stored below.
        let built = build(unsafe { core::slice::from_raw_parts_mut(handle.arena, handle.arena_size) });
        let after = if built.is_ok() { 0 } else { EMPTY };
        let result = built.map(|model| {
            // SAFETY: nobody else uses the model while it is being built.
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

/// A model that one call may change.
pub(crate) struct Claimed<'a, M: Model> {
    handle: &'a Handle<M>,
}

impl<M: Model> Claimed<'_, M> {
    pub(crate) fn model(&mut self) -> &mut M {
        // SAFETY: a handle that had no users has a model, and only this guard refers to it.
        unsafe { (*self.handle.model.get()).assume_init_mut() }
    }

    /// The memory of the model as far as it is known: all of it except a few bytes in front of the handle.
    pub(crate) fn regions(&self) -> [Region; 2] {
        self.handle.written_regions()
    }
}

impl<M: Model> Drop for Claimed<'_, M> {
    fn drop(&mut self) {
        self.handle.users.store(0, Ordering::Release);
    }
}

/// A model in use.
pub(crate) struct Shared<'a, M: Model> {
    handle: &'a Handle<M>,
}

impl<M: Model> Shared<'_, M> {
    pub(crate) fn model(&self) -> &M {
        // SAFETY: a handle with users has a model, and nobody writes to it while it has users.
        unsafe { (*self.handle.model.get()).assume_init_ref() }
    }

    /// The memory of the model as far as it is known: all of it except a few bytes in front of the handle.
    pub(crate) fn regions(&self) -> [Region; 2] {
        self.handle.regions()
    }
}

impl<M: Model> Drop for Shared<'_, M> {
    fn drop(&mut self) {
        self.handle.users.fetch_sub(1, Ordering::Release);
    }
}
