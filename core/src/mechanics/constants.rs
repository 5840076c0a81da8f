//! The constants of the mechanics.
//!
//! A user sets friction, clearance, time step, settle time and rest speed in
//! [`Params`](crate::params::Params). The constants here are fixed, in three groups: *physics* defines what
//! hanging is and how bodies are modelled; *tolerances* account for the errors of the cloud, of the
//! distance field and of the arithmetic; the *budget* bounds iterations and capacities. The public constants
//! of [`Margin`](super::Margin) stand beside it.
//!
//! Each comment says what a larger or smaller value does and where the value comes from. "Chosen by hand"
//! means that no comparison with other values is recorded. "The judge" is the verdict that `host-tests`
//! derives from Bullet and ODE; `cargo run --release -p host-tests --bin settle` counts how often the core
//! agrees with them.

// ---- Physics: gravity, damping, and the definitions of rest, fall and departure ----

/// Standard gravity, m/s².
pub const GRAVITY: f32 = 9.81;

/// Drop of the centre of mass beyond which an object has fallen, m; the larger of this and
/// [`FALL_EXTENT_RATIO`] times its largest extent.
///
/// Larger: an object that slides down to another part of the supporter still hangs. Smaller: an object that
/// settles deeply has fallen. The judge has the same limit; it is part of the definition of hanging.
pub(super) const FALL_HEIGHT: f32 = 0.06;
/// Drop of the centre of mass beyond which an object has fallen, as a fraction of its largest extent.
///
/// Larger and smaller as for [`FALL_HEIGHT`]. The judge has the same limit.
pub(super) const FALL_EXTENT_RATIO: f32 = 0.5;
/// Rotation since the release above which a fall is classified as `RotatesOff` instead of `SlidesOff`, rad.
///
/// Only the name of the outcome depends on it. Chosen by hand.
pub(super) const ROTATION_OFF_ANGLE: f32 = 0.7;

/// Interval over which the speed of the fastest point is averaged to detect rest, s.
///
/// Larger: rest is detected later. Smaller: the turning point of a swing is mistaken for rest. Chosen by
/// hand.
pub(super) const REST_WINDOW: f32 = 0.08;
/// Duration of the simulation with swinging, s: that of `let_go`.
///
/// Larger: fewer poses are still moving at the end, at more time. Smaller: the reverse. The judge decides
/// after the same time: four hardly damped seconds instead of three raised the agreement with Bullet from 90
/// to 92 %.
pub(super) const SWING_TIME: f32 = 4.0;
/// Speed of the centre of mass below which a touching object hangs at the end of [`SWING_TIME`], m/s.
///
/// Larger: an object that still slides hangs. Smaller: one that swings does not. The judge has the same
/// limit.
pub(super) const SWING_REST_SPEED: f32 = 0.05;

/// Damping rate of the centre of mass while there is contact, 1/s, for finding rest poses.
///
/// Larger: the body rests sooner, and a slow slide looks like rest. Smaller: the simulation is longer.
/// Equilibria do not depend on it. Chosen by hand.
pub(super) const DRAG: f32 = 2.0;
/// Damping rate of the rotation while there is contact, 1/s, for finding rest poses.
///
/// Larger and smaller as for [`DRAG`]. Chosen by hand.
pub(super) const SPIN_DRAG: f32 = 15.0;
/// Damping rate of the centre of mass while there is contact, 1/s, with swinging: that of `let_go`.
///
/// Larger: less swinging, fewer falls. Smaller: more of both. Lowered from 0.5 over 0.3 to 0.1 as the core
/// agreed with Bullet more often on seeds 7 and 100.
pub(super) const SWING_DRAG: f32 = 0.1;
/// Damping rate of the rotation while there is contact, 1/s, with swinging.
///
/// Larger and smaller as for [`SWING_DRAG`]. Lowered from 3 over 2 to 1.5 together with it.
pub(super) const SWING_SPIN_DRAG: f32 = 1.5;

/// Distance by which a body must move without contact under reversed gravity to have come free, m.
///
/// Larger: a ring with little play never comes free. Smaller: a wedged body that is pushed about comes free.
/// The judge has the same limit.
pub(super) const FREE_TRAVEL: f32 = 0.002;
/// Travel without contact under reversed gravity that is enough to be sure that the body comes free, m.
///
/// Larger: more time. Smaller: a loop with hardly more room than [`FREE_TRAVEL`] passes for a wide one. Of the poses of seed 100
/// that hold, 85 % come free in the judge where the travel ends by 3 mm, and 99.6 % of the others (`make calibrate`).
pub(crate) const ENOUGH_PLAY: f32 = 0.004;
/// Time within which a body must come free under reversed gravity, s.
///
/// Larger: more bodies come free, at more time for those that are wedged. Smaller: the reverse. Chosen by
/// hand; the judge allows 1.5 s.
pub(super) const FREEING_TIME: f32 = 0.5;

/// Rate at which gravity tilts, rad/s.
///
/// Larger: less time, but the body leaves at a larger angle than the one at which it began to. Smaller: the
/// tilt comes closer to the static limit, at more time. Chosen by hand.
pub(super) const TILT_RATE: f32 = 2.5;
/// Factor on the friction while gravity tilts slowly.
///
/// It stands for the swing of a sudden tilt, as when a robot stops: the body swings as far again beyond the
/// new equilibrium, and slips at the end of the swing although friction holds it in the middle. Larger: such
/// slips are not seen. Smaller: all poses look less firm. Value chosen by hand.
pub(super) const TILT_FRICTION_FACTOR: f32 = 0.7;
/// Tilt of gravity up to which sinking is recorded, rad.
///
/// Larger: a body rolls out of a hook that holds it well, which counts as sinking. Smaller: ledges go unseen.
/// Value chosen by hand. Of the poses of seeds 7 and 100 that survive every tilt nearly all that do not sink
/// hang (`docs/PROBABILITY.md`).
pub(super) const SINKING_TILT: f32 = 0.9;
/// Time without contact after which a body has left the supporter, s.
///
/// Larger: a body that falls past another part of the supporter has not left. Smaller: a hop counts as
/// leaving. Chosen by hand.
pub(super) const DEPARTURE_TIME: f32 = 0.1;

// ---- Tolerances of the cloud: points have a spacing, and normals have errors ----

/// Minimum distance between representatives with similar normals, m.
///
/// Larger: fewer patches, less time, and small features such as the lip at a bar's end go unseen. Smaller:
/// more patches and more time. Chosen by hand; `docs/MECHANICS.md` says which lips are seen.
pub(crate) const REPRESENTATIVE_SPACING: f32 = 0.0025;
/// Distance from the last patch of a bar to a surface across its way that it is taken to reach, metres: two patches, as there may be
/// no point of either where they join.
pub(super) const BAR_TO_SURFACE: f32 = 2.0 * REPRESENTATIVE_SPACING;
/// Minimum cosine between the normals of a representative and of a point that it stands for: about 25
/// degrees.
///
/// Larger: more patches. Smaller: edges and thin bars lose patches. Chosen by hand.
pub(super) const REPRESENTATIVE_COSINE: f32 = 0.9;

/// Maximum half extent of a patch, in distances between representatives.
///
/// Larger: patches make round bars thicker. Smaller: gaps between the patches, over which a body slides as
/// over a rasp. Chosen by hand.
pub(super) const PATCH_HALF_EXTENT: f32 = 0.8;
/// Minimum half extent of a patch, m: it keeps divisions by an extent finite.
pub(super) const MIN_PATCH_EXTENT: f32 = 1e-5;
/// Minimum cosine between a point's normal and the patch's normal there for the point to show that the
/// surface goes on.
///
/// Larger: noisy normals end patches too early. Smaller: a patch goes on over an edge. Chosen by hand.
pub(super) const SAME_SURFACE_COSINE: f32 = 0.75;
/// Minimum cosine between a point's normal and the patch's for the point to take part in the fit of the
/// curvature.
///
/// Larger: thin bars are fitted to too few points. Smaller: the far side of a bar distorts the fit. Chosen by
/// hand.
pub(super) const SAME_BAR_COSINE: f32 = 0.3;
/// Turn of the normals over half an extent below which a patch is straight in a direction, rad.
///
/// Larger: curved surfaces become facets. Smaller: errors of the normals make plane surfaces and bars curved,
/// and bodies catch there. Chosen by hand.
pub(super) const STRAIGHT_TURN: f32 = 0.15;
/// Weight of the curvature of both sides in the fit of the curvature of one side, as a fraction of the square
/// of the fit's radius.
///
/// Larger: a seam between a straight and a round part is smoothed. Smaller: a side with few points is left to
/// their noise. Chosen by hand.
pub(super) const BOTH_SIDES_WEIGHT: f32 = 0.1;
/// Sine of the angle by which a patch may turn from its centre to its rim.
///
/// Larger: the rim of a patch on a thin bar becomes vertical and its shape inexact. Smaller: gaps between
/// patches of a thin bar. Chosen by hand; it must be below 1.
pub(super) const MAX_PATCH_SINE: f32 = 0.9;
/// Range beyond a patch in which points show that the surface goes on, in point distances.
///
/// Larger: a real end is missed when another surface begins behind it. Smaller: by chance no point lies in
/// the range, and a false end in the middle of a bar catches bodies. Chosen by hand, so that bars sampled by
/// few points have no ends in their middle.
pub(super) const END_SEARCH_RANGE: f32 = 2.5;
/// Distance beyond a patch within which a surface without further points has ended, in point distances.
///
/// Larger: false ends. Smaller: real ends are missed, and the patch's rim holds a body that would slide off.
/// Chosen by hand.
pub(super) const END_MARGIN: f32 = 0.5;
/// Maximum variance of points across a wire, in both directions together, as a fraction of their variance
/// along it.
///
/// Larger: surfaces seen in a narrow strip become wires. Smaller: short stretches of wire are fitted as
/// surfaces. Chosen by hand.
pub(super) const WIRE_VARIANCE_RATIO: f32 = 0.15;
/// Minimum number of points on a wire.
///
/// Larger: sparse wires are not recognised. Smaller: any few points in a line are a wire. Chosen by hand.
pub(super) const MIN_WIRE_POINTS: f32 = 4.0;
/// Observed length of a wire to one side below which it ends there, in half extents of the patch.
///
/// Larger: false ends in the middle of sparse wires. Smaller: real ends are missed. Chosen by hand.
pub(super) const WIRE_END_RATIO: f32 = 1.5;
/// Regularisation of the curvature fit, as a fraction of the trace of the points' scatter matrix.
///
/// It matters where points lie on a line and determine nothing across it. Larger: curvatures are
/// underestimated. Smaller: errors of the normals are amplified there. Chosen by hand.
pub(super) const CURVATURE_REGULARISATION: f32 = 0.01;
/// Fraction of a patch's half extent that is certain to be filled by the supporter, for the test whether a
/// bar or a plane passes through the object.
///
/// Larger: poses beside a bar's end are rejected. Smaller: a thin sheet is missed between two points. Chosen
/// by hand.
pub(super) const FILLED_RATIO: f32 = 0.7;
/// Fraction of a patch's half extent beyond which a contact is on the rim.
///
/// Larger: rims are missed, and the body's normal acts where the patches' should. Smaller: contacts inside a
/// curved patch get the patch's normal. Chosen by hand.
pub(super) const RIM_RATIO: f32 = 0.9;
/// Distance from the object, m, within which a guessed part of the supporter counts as near: the error of a guess that was
/// wrong.
///
/// Larger: parts that the object does not touch dilute the share. Smaller: a guess that is wrong by as much is missed. Chosen
/// by hand from 5 and 10 mm.
pub(super) const NEAR_GUESS: f32 = 0.005;
/// Distance from the mesh, m, at which rays to the cameras start: more than its noise, so that a point that touches the mesh
/// from the side of a camera is seen.
pub(super) const OFF_MESH: f32 = 0.001;
/// Penetration of a patch beyond which the supporter passes through the object, m.
///
/// Larger: thin walls pushed through the supporter go unseen. Smaller: the errors of patches against the
/// surface reject good poses. Chosen by hand.
pub(super) const PATCH_PENETRATION: f32 = 0.001;
/// Distance by which a shift off the supporter exceeds what is missing, m, so that rounding does not ask for another one.
pub(super) const PUSH_OFF_EXCESS: f32 = 0.0001;
/// Shifts at most to bring a pose off the supporter, where the field said that it is clear.
///
/// Larger: more time for poses in holes that are too narrow, where shifts alternate between two sides. Smaller: poses that touch
/// in several places are refused. Chosen by hand.
pub(super) const MAX_PUSHES_OFF: usize = 8;

// ---- Tolerances of the distance field: it is interpolated between voxels, and exact only near the mesh ----

/// Fraction of the field's band up to which its distances are used: beyond the band they are lower bounds.
///
/// Larger: bounds are taken for distances at the edge of the band. Smaller: more queries of the mesh. Chosen
/// by hand.
pub(super) const FIELD_BAND_RATIO: f32 = 0.9;
/// Excess of the field over the distance to the mesh beyond which the field misses a thin part, in voxels.
///
/// Larger: thin parts, such as the strings of a racquet, pass through the supporter. Smaller: the field's
/// error rejects good poses. Chosen by hand.
pub(super) const FIELD_ERROR: f32 = 0.3;
/// Depth in the field beyond which a point is certain to be inside the object, in voxels.
///
/// Deeper contacts keep the field's normal, which leads out. Larger: in thin walls the mesh's nearest face
/// may lead the wrong way. Smaller: more contacts keep the field's errors. It is the field's error in thin
/// walls and at edges, half a voxel.
pub(super) const CERTAIN_DEPTH: f32 = 0.5;
/// Cosine between a contact's normal and the distance gradient beyond which the body is behind the patch.
///
/// Larger: contacts with other sides of the supporter push. Smaller: errors of the normals discard contacts.
/// Chosen by hand.
pub(super) const BEHIND_COSINE: f32 = 0.3;
/// Distance behind a patch up to which a sheet without an inside counts as penetrating it, in voxels; such a
/// sheet has positive gaps on both sides.
///
/// Larger: sheets are pulled to the wrong side of a thin supporter. Smaller: sheets sink through it. Chosen
/// by hand.
pub(super) const SHEET_DEPTH: f32 = 0.5;

/// Offset from a patch at which the mesh is queried, m.
///
/// At zero distance the side of the surface is undefined and an edge has no direction. Larger: another face
/// is nearest. Smaller: rounding decides on the side. Chosen by hand.
pub(super) const SURFACE_QUERY_OFFSET: f32 = 0.0002;
/// Minimum cosine between the patch's normal and the body's for the mesh to be queried along the patch's
/// normal; otherwise the query goes along the body's.
///
/// Larger: the field's normal is used more often. Smaller: queries graze the surface. Chosen by hand.
pub(super) const FACING_COSINE: f32 = 0.5;
/// Minimum cosine between the direction of a query and the direction to the mesh for the mesh to be on the
/// expected side.
///
/// Larger: contacts at edges keep the field's normal. Smaller: faces on the other side of a thin wall are
/// accepted. Chosen by hand.
pub(super) const SAME_SIDE_COSINE: f32 = 0.3;

// ---- Numerical tolerances of contacts, of the search for the nearest point and of the solver ----

/// Gap below which contacts are kept, in addition to the distance that gravity can close, m.
///
/// Larger: more contacts per step. Smaller: a body at rest loses and regains contacts. Chosen by hand.
pub(super) const CONTACT_MARGIN: f32 = 0.0003;
/// Distance below which contacts with similar normals are merged, m.
///
/// Larger: corners of small faces are lost. Smaller: redundant contacts fill the list. Chosen by hand.
pub(super) const MERGE_DISTANCE: f32 = 0.003;
/// Minimum cosine between the normals of merged contacts.
///
/// Larger: redundant contacts fill the list. Smaller: contacts on both flanks of an edge merge. Chosen by
/// hand.
pub(super) const MERGE_COSINE: f32 = 0.9;
/// Travel of the pivot after which the odometer restarts, m.
///
/// Larger: looser bounds for sleeping patches. Smaller: more restarts, each with a search for contacts.
/// Chosen by hand.
pub(super) const PIVOT_TRAVEL: f32 = 0.006;
/// Travel of any point of the body after which contacts are searched again, m.
///
/// Larger: contacts are outdated. Smaller: more searches. Chosen by hand.
pub(super) const CARRY_TRAVEL: f32 = 0.003;

/// Initial guess for the curvature of the touching surface, 1/m (radius 8 mm).
///
/// Larger: shorter first steps of the secant method. Smaller: longer ones, which overshoot on thin handles.
/// Chosen by hand.
pub(super) const INITIAL_CURVATURE: f32 = 125.0;
/// Curvature of the hollows of a body, 1/m (radius 10 mm), that the estimate of the nearest point of a patch allows for.
///
/// Larger: more patches are searched. Smaller: contacts in narrow hollows are found late. Chosen by hand.
pub(super) const HOLLOW_CURVATURE: f32 = 100.0;
/// Fraction of the estimated distance to a patch that the body may travel before the patch is searched again.
///
/// Larger: contacts are found late where the estimate is wrong. Smaller: more searches. Chosen by hand.
pub(super) const REVISIT_RATIO: f32 = 0.8;
/// Slope of the gap along a patch below which the secant method has converged.
///
/// Larger: contacts away from the nearest point. Smaller: more steps. Chosen by hand.
pub(super) const FLAT_SLOPE: f32 = 0.02;
/// Maximum step per slope of the secant method, in multiples of the initial one.
///
/// Larger: overshoots where the slope hardly changes. Smaller: slow convergence on flat surfaces. Chosen by
/// hand.
pub(super) const MAX_STRIDE_GROWTH: f32 = 4.0;
/// Factor on a step of the secant method that did not reduce the gap.
///
/// Larger: more failed steps. Smaller: steps too short to arrive. Chosen by hand.
pub(super) const STRIDE_REDUCTION: f32 = 0.3;
/// Step below which the refinement on the mesh has converged, m.
///
/// Larger: less exact contacts. Smaller: more queries of the mesh. Chosen by hand.
pub(super) const REFINEMENT_TOLERANCE: f32 = 3e-5;
/// Minimum curvature of a patch in the refinement on the mesh, 1/m: without it the step on a flat patch is
/// infinite.
///
/// Larger: shorter steps. Smaller: longer steps, which overshoot. Chosen by hand.
pub(super) const MIN_REFINEMENT_CURVATURE: f32 = 50.0;
/// Half length below which a part of a patch is not cut further, m.
///
/// Larger: less exact bounds on long patches. Smaller: more queries. Chosen by hand, just above the half
/// extent of a patch of a dense cloud, 2 mm ([`PATCH_HALF_EXTENT`] times [`REPRESENTATIVE_SPACING`]).
pub(super) const MIN_PART_LENGTH: f32 = 0.0021;
/// Half length below which a part of a patch is not cut further, in half widths: then the width determines
/// its bound.
///
/// Larger and smaller as for [`MIN_PART_LENGTH`]. Chosen by hand.
pub(super) const MIN_PART_ASPECT: f32 = 0.5;

/// Change of an impulse below which the solver has converged, m/s for the unit mass.
///
/// Larger: contacts creep. Smaller: more sweeps. Chosen by hand: a fraction of a thousandth of the speed that
/// gravity adds in a step.
pub(super) const SOLVER_TOLERANCE: f32 = 1e-5;
/// Penetration that is not corrected, m.
///
/// Larger: bodies rest deeper in the supporter. Smaller: contacts come and go. Chosen by hand.
pub(super) const PENETRATION_SLOP: f32 = 1e-4;
/// Fraction of the penetration beyond [`PENETRATION_SLOP`] that one step corrects.
///
/// Larger: corrections overshoot where contacts disagree. Smaller: bodies stay deeper for longer. Chosen by
/// hand.
pub(super) const PENETRATION_CORRECTION: f32 = 0.3;
/// Maximum lift per step of the search for a release pose, m.
///
/// Larger: the lift passes a narrow gap. Smaller: more steps are needed for the same clearance. Chosen by
/// hand.
pub(super) const RELEASE_LIFT: f32 = 0.0005;
/// Excess of the gap that the search for a release pose aims at over the clearance, m: twice
/// [`PENETRATION_SLOP`], so that the correction ends beyond the clearance. Chosen by hand.
pub(super) const RELEASE_EXCESS: f32 = 2e-4;

// ---- Budget: iterations and capacities ----

/// Maximum number of contacts that the solver handles.
///
/// Larger: more time per step. Smaller: flat contacts lose corners. Chosen by hand. Contacts that are spread
/// are kept: with the twelve deepest, a plate on a plane never stopped rocking.
pub(super) const MAX_SOLVER_CONTACTS: usize = 12;
/// Maximum number of solver sweeps per step.
///
/// Larger: more exact impulses, more time. Smaller: bodies with many contacts sink and creep. Chosen by hand.
pub(super) const SOLVER_SWEEPS: usize = 12;
/// Number of sweeps that correct penetration.
///
/// Larger and smaller as for [`SOLVER_SWEEPS`]. Chosen by hand.
pub(super) const CORRECTION_SWEEPS: usize = 4;
/// Number of steps for which contacts move along with the body before they are searched again.
///
/// Larger: less time. With two, a body without friction did not come to rest. Zero searches in every step.
pub(super) const CARRIED_STEPS: u8 = 1;
/// Number of steps from rest after which the contact forces are read.
///
/// Larger: the body may move on. Smaller: the impulses have not converged from zero. Chosen by hand.
pub(super) const FORCE_STEPS: usize = 3;

/// Maximum number of patches in a group that sleeps together.
///
/// Larger: fewer tests of groups, more of patches. Smaller: the reverse. Chosen by hand.
pub(super) const GROUP_SIZE: usize = 8;
/// Maximum number of points for the fit of a patch; of more, a subset spread over all is used.
///
/// Larger: more memory on the stack and more time for dense clouds. Smaller: noisier fits. Chosen by hand.
pub(super) const MAX_FIT_POINTS: usize = 128;
/// Number of points at which the spacing of the cloud is measured.
///
/// Larger: a steadier median. Smaller: less time. Chosen by hand.
pub(super) const SPACING_PROBES: usize = 64;
/// Number of points, itself included, over which the spacing around a point is averaged by the median.
///
/// Larger: the spacing of another part of the cloud counts as well. Smaller: chance decides. Chosen by hand.
pub(super) const SPACING_NEIGHBOURS: usize = 9;
/// Ratio of the spacing around a point to that of the cloud beyond which the local one counts.
///
/// Larger: a sparse wall behind a dense hook has gaps between its patches. Smaller: chance makes patches of a uniform cloud
/// differ in size, with gaps between them. Over points sampled at random the median of nine is within a factor of 1.6.
pub(super) const SPACING_RATIO: f32 = 2.0;
/// Number of power iterations for the direction of a wire.
///
/// A wire's greatest eigenvalue is at least 6.7 times the next one ([`WIRE_VARIANCE_RATIO`]), so each
/// iteration divides the error by as much.
pub(super) const POWER_ITERATIONS: usize = 4;

/// Maximum number of steps of the secant method on a patch.
///
/// Larger: contacts closer to the nearest point, more queries. Smaller: the reverse. Chosen by hand.
pub(super) const SECANT_STEPS: usize = 4;
/// Maximum number of refinement steps on the mesh.
///
/// Larger: more exact contacts, more queries. Smaller: the reverse. Chosen by hand.
pub(super) const REFINEMENT_STEPS: usize = 3;
/// Maximum number of parts of a patch.
///
/// Larger: more queries for long patches. Smaller: less exact bounds on them. Chosen by hand: in a scene in
/// millimetres that is read as metres, patches would be cut into thousands of parts.
pub(super) const MAX_PARTS: f32 = 64.0;
/// Capacity of the stack of a patch's parts. A patch is cut in two at most six times ([`MAX_PARTS`]), so at
/// most seven parts wait.
pub(super) const PART_STACK: usize = 8;

/// Number of steps of the search for a release pose that lift straight up, which is how an object is taken
/// off.
///
/// Larger: a higher straight lift, by up to [`RELEASE_LIFT`] per step. Smaller: the object turns out of its
/// contacts sooner. Chosen by hand.
pub(super) const RELEASE_LIFTS: usize = 10;
/// Maximum number of steps of the search for a release pose.
///
/// Larger: tight openings get more clearance, at more time. Smaller: less of both. Chosen by hand.
pub(super) const RELEASE_STEPS: usize = 30;
