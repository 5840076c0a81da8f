//! The opening of an object in which a bar lies: how deep it holds the bar, and how high it is.
//!
//! *Down* is the direction of gravity when the object hangs: from a contact towards the centre of mass.

use crate::geometry::{Point, Surface, Vector, any_perpendicular, rotate_about, unit_or};
use crate::monitor::{Meter, Stop};

/// Depths below a contact at which rays to both sides test whether a bar is caught, metres.
const DEPTHS: [f32; 6] = [0.0015, 0.003, 0.006, 0.012, 0.024, 0.048];
/// Bar directions tried below a contact, evenly over half a turn: 7.5 degrees apart, because a wire of 3 mm to the side of a bar at
/// 15 mm is missed from 6 degrees on. With 6, 12, 18, 24 and 32 directions, 274, 276, 287, 294 and 301 of 320 best poses are of the
/// same kind at the same place in turned frames (`meant turned --pairs 160`, seeds 41 and 141). Larger: more rays.
const BAR_DIRECTIONS: u32 = 24;
/// Least height that is told apart, metres: hooks and handles that are made for bars open by as much, and a bar has little play in what
/// is lower. Without it, the best poses of racquets are in the tightest meshes of their strings: of 640 pairs 609 instead of 614 hang on
/// seed 1 (`tables --summary --engine bullet --profile default --pairs 600`), of 1024 pairs of seeds 43 to 46 991 instead of 992.
const LEAST_HEIGHT: f32 = 0.03;

/// How far a bar, a line without thickness along the unit vector `bar`, must move `down` from `contact` before it can leave to
/// either side, metres; 0 if it is not caught. `room` is the distance from the contact down to the surface opposite, metres,
/// infinite if there is none.
pub(super) fn capture(
    surface: &Surface,
    contact: &Point,
    (down, bar): (&Vector, &Vector),
    room: f32,
    meter: &mut Meter,
) -> Result<f32, Stop> {
    let side = unit_or(bar.cross(down), any_perpendicular(*down));
    for depth in depths(room) {
        if is_closed(surface, &(contact + down * depth), &side, meter)? {
            return Ok(depth);
        }
    }
    Ok(0.0)
}

/// The direction of the bar that is caught deepest below `contact`, as a unit vector perpendicular to `down` whose sign has no
/// meaning, and what [`capture`] returns for it. Of a range of directions it is the middle one, so that the choice does not turn on the
/// object's frame.
pub(super) fn deepest_bar(
    surface: &Surface,
    contact: &Point,
    down: &Vector,
    room: f32,
    meter: &mut Meter,
) -> Result<(Vector, f32), Stop> {
    let reference = any_perpendicular(*down);
    let side =
        |step: f32| rotate_about(*down, core::f32::consts::PI / BAR_DIRECTIONS as f32 * step, reference);
    for depth in depths(room) {
        let from = contact + down * depth;
        let mut closed = 0;
        for step in 0..BAR_DIRECTIONS {
            closed |= u32::from(is_closed(surface, &from, &side(step as f32), meter)?) << step;
        }
        if closed != 0 {
            return Ok((side(middle_of_longest_run(closed)).cross(down), depth));
        }
    }
    Ok((reference, 0.0))
}

/// The depths above the surface opposite, from the deepest up: a crease right below the contact may catch nothing although a
/// deeper level does.
fn depths(room: f32) -> impl Iterator<Item = f32> {
    DEPTHS.into_iter().rev().filter(move |depth| *depth < room)
}

/// Whether the surface is to both sides of a point.
fn is_closed(surface: &Surface, from: &Point, side: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
    meter.rays(2)?;
    Ok(surface.any_hit(from, side) && surface.any_hit(from, &-side))
}

/// Middle of the longest run of set bits among the lowest `BAR_DIRECTIONS`, of which the last is next to the first; of equally
/// long runs that of the lowest bit. At least one bit is set.
fn middle_of_longest_run(bits: u32) -> f32 {
    // Bit k of `starts` says that at least `length` bits from k on are set.
    let (mut starts, mut length) = (bits, 1);
    while length < BAR_DIRECTIONS {
        let longer = starts & (starts >> 1 | (starts & 1) << (BAR_DIRECTIONS - 1));
        if longer == 0 {
            break;
        }
        (starts, length) = (longer, length + 1);
    }
    starts.trailing_zeros() as f32 + 0.5 * (length - 1) as f32
}

/// Height of the opening: how far the bar moves down until it can leave to a side or is stopped, metres; at least
/// [`LEAST_HEIGHT`], also where nothing is caught, and infinite if it can do neither within 48 mm. It follows from what [`capture`]
/// returns and takes.
pub(super) fn height(capture: f32, room: f32) -> f32 {
    let free = DEPTHS.into_iter().find(|depth| *depth > capture).unwrap_or(f32::INFINITY);
    free.min(room).max(LEAST_HEIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::{Arena, model_bytes};
    use crate::test_shapes;
    use nalgebra::UnitQuaternion;

    /// A wire of 2 mm hides a bar's sides only within 4 degrees.
    #[test]
    fn the_deepest_bar_through_a_thin_ring_is_along_its_axis_in_every_frame() {
        let (ring, tube) = (0.015, 0.001);
        let shape = test_shapes::torus(ring, tube, 96, 16);
        for k in 0..24 {
            let k = k as f32;
            let turn = UnitQuaternion::from_euler_angles(0.9 * k, 0.4 * k, 1.7 * k);
            let turned = shape.map(|p| turn * p);
            let mesh = turned.mesh();
            let count = mesh.triangles().len();
            let needed = model_bytes(Surface::bytes(count) + Surface::scratch_bytes(count));
            let mut memory = vec![0; needed];
            let mut arena = Arena::new(&mut memory, needed).unwrap();
            let meter = &mut Meter::unwatched();
            let surface = Surface::build(&mesh, false, &mut arena, meter).unwrap();
            let contact = turn * Point::new(ring - tube - 1e-4, 0.0, 0.0);
            let (down, axis) = (turn * -Vector::x(), turn * Vector::z());
            let (bar, depth) = deepest_bar(&surface, &contact, &down, 2.0 * (ring - tube), meter).unwrap();
            assert_eq!(depth, 0.024, "frame {k}");
            let off = bar.cross(&axis).norm().asin().to_degrees();
            assert!(off <= 0.5 * 180.0 / BAR_DIRECTIONS as f32, "{off} degrees in frame {k}");
        }
    }

    #[test]
    fn the_middle_of_the_longest_run() {
        let last = 1 << (BAR_DIRECTIONS - 1);
        assert_eq!(middle_of_longest_run(0b1000), 3.0);
        assert_eq!(middle_of_longest_run(0b11), 0.5);
        assert_eq!(middle_of_longest_run(0b0111_0011), 5.0);
        assert_eq!(middle_of_longest_run(0b0110_0011), 0.5, "the first of two of a length");
        let around = BAR_DIRECTIONS as f32;
        assert_eq!(
            middle_of_longest_run(last | 0b0100_0011),
            around,
            "from the last bit over the first to the second"
        );
        assert_eq!(middle_of_longest_run(2 * last - 1), 0.5 * (BAR_DIRECTIONS - 1) as f32, "all");
    }
}
