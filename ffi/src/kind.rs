use crate::failure::Failure;
use core::ffi::{CStr, c_char};
use hangpose_core::mechanics::{Kind, Kinds};

/// How an object hangs, one of HANGPOSE_KIND_*; or a set of kinds, joined with |. It is decided for the rest pose, from
/// the shapes alone. A bar is the part of the supporter at a contact that carries the object.
pub type hangpose_kind = u32;

/// A bar of the supporter runs through a loop of the object. The two are linked: no motion frees the object but one
/// past the end of the bar.
pub const HANGPOSE_KIND_THREADED: hangpose_kind = 1;
/// An open hook of the one holds the other: the object is caught on both sides of the bar, and comes free by lifting.
pub const HANGPOSE_KIND_HOOKED: hangpose_kind = 2;
/// The object stands over a tip of the supporter with its cavity, as a cap on a peg or a mug upside down.
pub const HANGPOSE_KIND_CAPPED: hangpose_kind = 4;
/// The object is caught on one side at most: friction or balance holds it.
pub const HANGPOSE_KIND_BALANCED: hangpose_kind = 8;
/// Every kind.
pub const HANGPOSE_KIND_ALL: hangpose_kind = 15;

/// Returns the name of one kind: "threaded", "hooked", "capped" or "balanced", and "no kind" for anything else; a
/// static string, never null.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_kind_string(kind: hangpose_kind) -> *const c_char {
    kind_text(kind).as_ptr()
}

/// The name in the core, with the NUL that C needs.
fn kind_text(kind: hangpose_kind) -> &'static CStr {
    match kind {
        HANGPOSE_KIND_THREADED => c"threaded",
        HANGPOSE_KIND_HOOKED => c"hooked",
        HANGPOSE_KIND_CAPPED => c"capped",
        HANGPOSE_KIND_BALANCED => c"balanced",
        _ => c"no kind",
    }
}

/// The number of a kind.
pub(crate) fn kind(kind: Kind) -> hangpose_kind {
    match kind {
        Kind::Threaded => HANGPOSE_KIND_THREADED,
        Kind::Hooked => HANGPOSE_KIND_HOOKED,
        Kind::Capped => HANGPOSE_KIND_CAPPED,
        Kind::Balanced => HANGPOSE_KIND_BALANCED,
    }
}

/// The numbers of the kinds in a set, joined.
pub(crate) fn mask(kinds: Kinds) -> hangpose_kind {
    Kind::ALL.into_iter().filter(|one| kinds.contains(*one)).fold(0, |mask, one| mask | kind(one))
}

/// The set of the kinds in a mask.
pub(crate) fn kinds(field: &'static str, mask: hangpose_kind) -> Result<Kinds, Failure> {
    if mask > HANGPOSE_KIND_ALL {
        return Err(Failure::Choice { field, value: mask, most: HANGPOSE_KIND_ALL });
    }
    let mut chosen = Kind::ALL;
    let mut count = 0;
    for one in Kind::ALL.into_iter().filter(|one| mask & kind(*one) != 0) {
        chosen[count] = one;
        count += 1;
    }
    Ok(Kinds::of(&chosen[..count]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_the_names_of_the_core() {
        for one in Kind::ALL {
            assert_eq!(kind_text(kind(one)).to_str(), Ok(one.name()));
        }
        assert_eq!(kind_text(0), c"no kind");
        assert_eq!(kind_text(HANGPOSE_KIND_ALL), c"no kind");
    }

    #[test]
    fn every_mask_is_a_set() {
        for given in 0..=HANGPOSE_KIND_ALL {
            assert_eq!(kinds("request.allow", given).map(mask), Ok(given));
        }
        assert_eq!(mask(Kinds::ALL), HANGPOSE_KIND_ALL);
        assert!(kinds("request.allow", HANGPOSE_KIND_ALL + 1).is_err());
    }
}
