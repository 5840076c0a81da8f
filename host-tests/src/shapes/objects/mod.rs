//! Objects.

mod kitchen;
mod sports;
mod tools;
mod trinkets;
mod unhangable;
mod vessels;
mod worn;

use super::{HangObject, ObjectKind, OpeningKind, Random};

const fn hangable(name: &'static str, make: fn(&mut Random) -> HangObject) -> ObjectKind {
    ObjectKind { name, is_hangable: true, make }
}

const fn unhangable(name: &'static str, make: fn(&mut Random) -> HangObject) -> ObjectKind {
    ObjectKind { name, is_hangable: false, make }
}

/// All kinds of objects.
pub const OBJECTS: &[ObjectKind] = &[
    hangable("bag", worn::bag),
    hangable("cap", worn::cap),
    hangable("clothes hanger", worn::clothes_hanger),
    hangable("headphone", worn::headphone),
    hangable("utensil", kitchen::utensil),
    hangable("knife", kitchen::knife),
    hangable("pan", kitchen::pan),
    hangable("mug", vessels::mug),
    hangable("goblet", vessels::goblet),
    hangable("bucket", vessels::bucket),
    hangable("basket", vessels::basket),
    hangable("watering can", vessels::watering_can),
    hangable("racquet", sports::racquet),
    hangable("scissors", tools::scissors),
    hangable("wrench", tools::wrench),
    hangable("lantern", tools::lantern),
    hangable("picture frame", tools::picture_frame),
    hangable("carabiner", trinkets::carabiner),
    hangable("padlock", trinkets::padlock),
    hangable("key", trinkets::key),
    hangable("tape roll", trinkets::tape_roll),
    hangable("ring", trinkets::ring),
    unhangable("ball", unhangable::ball),
    unhangable("box", unhangable::cuboid),
    unhangable("can", unhangable::can),
    unhangable("bottle", unhangable::bottle),
    unhangable("banana", unhangable::banana),
    unhangable("wedge", unhangable::wedge),
    unhangable("book", unhangable::book),
    unhangable("dome", unhangable::dome),
];
