// The scene that hangpose writes into the page: its types, and its reader, which names the place of whatever is wrong.
// Lengths are metres, angles radians, times seconds.

export type Vec3 = readonly [number, number, number];
export type Vec4 = readonly [number, number, number, number];

/** Maps object coordinates to supporter coordinates. */
export interface Pose {
  position: Vec3;
  quaternion_xyzw: Vec4;
}

export interface Waypoint extends Pose {
  seconds: number;
}

/** Points with a unit normal each, or without normals. */
export interface Points {
  positions: Float32Array;
  normals: Float32Array;
}

export interface SceneObject {
  name: string;
  triangleCount: number;
  positions: Float32Array;
  indices: Uint32Array;
  centreOfMass: Vec3;
  samples: Float32Array;
  contacts: Points;
  viewpoints: Vec3[];
}

export interface Supporter {
  name: string;
  pointCount: number;
  up: Vec3;
  points: Points;
  guessed: Float32Array;
  contacts: Points;
  viewpoints: Vec3[];
}

/** A capsule of the gripper, closed, in object coordinates. */
export interface GripperPart {
  from: Vec3;
  to: Vec3;
  radius: number;
  opening: Vec3;
}

export interface Unseen {
  object: number;
  shadow: number;
  supporter: number;
  object_view: Vec3;
  supporter_view: Vec3;
}

export interface Margin {
  tilts: number[];
  jolt_time: number;
  tilted_sinking: number;
  escape_rise: number;
  centre_of_mass_radius: number;
  escape_ratio: number;
  knock_speed: number;
}

export interface Contact {
  position: Vec3;
  normal: Vec3;
  force: number;
}

export interface Path {
  waypoints: Waypoint[];
  /** Index of the release pose. */
  release: number;
  /** The opened gripper, in the same seconds as the object. */
  gripper: Waypoint[];
  clearance: number | null;
}

/** Fields that a pose of the published method lacks are null. */
export interface HangingPose {
  rank: number;
  release: Pose;
  rest: Pose | null;
  kind: string | null;
  probability: number | null;
  robustness: number | null;
  sinking: number | null;
  clearance: number | null;
  tolerance: { position: number; rotation: number } | null;
  unseen: Unseen | null;
  margin: Margin | null;
  contacts: Contact[];
  motion: Waypoint[];
  path: Path | null;
  /** Why no path was found, in words. */
  pathFailure: string | null;
}

export interface Fallen {
  fate: string;
  release: Pose;
  motion: Waypoint[];
}

export interface Counts {
  released: number;
  at_rest: number;
  rotated_off: number;
  slid_off: number;
  moving: number;
}

export interface Scene {
  version: string;
  mostTilt: number;
  object: SceneObject;
  supporter: Supporter;
  obstacles: Float32Array;
  gripper: { parts: GripperPart[]; retreat: Vec3 } | null;
  poses: HangingPose[];
  fallen: Fallen[];
  counts: Counts | null;
  rejection: { stage: string; reason: string } | null;
  seconds: { object: number; supporter: number; matching: number } | null;
}

/** The version of the scene that this page reads. */
const SCHEMA = 1;

/** Largest tilt of gravity that hangpose tests, radians; for scenes that do not say it. */
const MOST_TILT = 1.2;

type Json = { [key: string]: unknown };

class SceneError extends Error {
  constructor(where: string, what: string) {
    super(`${where}: ${what}`);
    this.name = "SceneError";
  }
}

function record(value: unknown, where: string): Json {
  if (typeof value !== "object" || value === null || Array.isArray(value))
    throw new SceneError(where, "is not an object");
  return value as Json;
}

function list(value: unknown, where: string): unknown[] {
  if (!Array.isArray(value)) throw new SceneError(where, "is not an array");
  return value;
}

function text(value: unknown, where: string): string {
  if (typeof value !== "string") throw new SceneError(where, "is not a string");
  return value;
}

function number(value: unknown, where: string): number {
  if (typeof value !== "number" || !Number.isFinite(value)) throw new SceneError(where, "is not a number");
  return value;
}

function orNull<T>(value: unknown, where: string, read: (value: unknown, where: string) => T): T | null {
  return value === null || value === undefined ? null : read(value, where);
}

function numbers(value: unknown, where: string, count: number): number[] {
  const values = list(value, where);
  if (values.length !== count) throw new SceneError(where, `has ${values.length} numbers, not ${count}`);
  return values.map((v, i) => number(v, `${where}[${i}]`));
}

function vector(value: unknown, where: string): Vec3 {
  return numbers(value, where, 3) as unknown as Vec3;
}

function pose(value: unknown, where: string): Pose {
  const { position, quaternion_xyzw } = record(value, where);
  return {
    position: vector(position, `${where}.position`),
    quaternion_xyzw: numbers(quaternion_xyzw, `${where}.quaternion_xyzw`, 4) as unknown as Vec4,
  };
}

function waypoint(value: unknown, where: string): Waypoint {
  return { ...pose(value, where), seconds: number(record(value, where).seconds, `${where}.seconds`) };
}

function each<T>(value: unknown, where: string, read: (value: unknown, where: string) => T): T[] {
  return list(value, where).map((item, i) => read(item, `${where}[${i}]`));
}

/** Bytes of base64; every machine that runs a browser is little-endian, as the numbers are. */
function bytes(value: unknown, where: string, unit: number): ArrayBuffer {
  let binary: string;
  try {
    binary = atob(text(value, where));
  } catch {
    throw new SceneError(where, "is not base64");
  }
  if (binary.length % unit !== 0) throw new SceneError(where, `has ${binary.length} bytes, no multiple of ${unit}`);
  const read = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) read[i] = binary.charCodeAt(i);
  return read.buffer;
}

export function floats(value: unknown, where: string, stride: number): Float32Array {
  return new Float32Array(bytes(value, where, 4 * stride));
}

function points(value: unknown, where: string): Points {
  const fields = record(value, where);
  return withNormals(fields.positions, fields.normals, where, `${where}.positions`, `${where}.normals`);
}

function withNormals(at: unknown, out: unknown, where: string, whereAt: string, whereOut: string): Points {
  const positions = floats(at, whereAt, 3);
  const normals = floats(out ?? "", whereOut, 3);
  if (normals.length !== 0 && normals.length !== positions.length) {
    throw new SceneError(where, `has ${positions.length / 3} points but ${normals.length / 3} normals`);
  }
  return { positions, normals };
}

function motion(value: unknown, where: string): Waypoint[] {
  const fields = record(value, where);
  const seconds = floats(fields.seconds, `${where}.seconds`, 1);
  const poses = floats(fields.poses, `${where}.poses`, 7);
  if (poses.length !== 7 * seconds.length) {
    throw new SceneError(where, `has ${seconds.length} times but ${poses.length / 7} poses`);
  }
  return Array.from(seconds, (at, i) => {
    const [x, y, z, qx, qy, qz, qw] = poses.subarray(7 * i, 7 * i + 7) as unknown as number[] as [
      number,
      number,
      number,
      number,
      number,
      number,
      number,
    ];
    return { seconds: at, position: [x, y, z], quaternion_xyzw: [qx, qy, qz, qw] };
  });
}

function object(value: unknown): SceneObject {
  const o = record(value, "object");
  const positions = floats(o.positions, "object.positions", 3);
  const indices = new Uint32Array(bytes(o.indices, "object.indices", 12));
  const beyond = indices.findIndex((index) => index >= positions.length / 3);
  if (beyond >= 0) {
    throw new SceneError(
      `object.indices[${beyond}]`,
      `is ${indices[beyond]}, but there are ${positions.length / 3} vertices`,
    );
  }
  return {
    name: text(o.name, "object.name"),
    triangleCount: number(o.triangle_count, "object.triangle_count"),
    positions,
    indices,
    centreOfMass: vector(o.centre_of_mass, "object.centre_of_mass"),
    samples: floats(o.samples, "object.samples", 3),
    contacts: points(o.contacts, "object.contacts"),
    viewpoints: each(o.viewpoints, "object.viewpoints", vector),
  };
}

function supporter(value: unknown): Supporter {
  const s = record(value, "supporter");
  const up = vector(s.up, "supporter.up");
  if (Math.hypot(...up) < 1e-6) throw new SceneError("supporter.up", "has no direction");
  return {
    name: text(s.name, "supporter.name"),
    pointCount: number(s.point_count, "supporter.point_count"),
    up,
    points: withNormals(s.points, s.normals, "supporter", "supporter.points", "supporter.normals"),
    guessed: floats(s.guessed, "supporter.guessed", 3),
    contacts: points(s.contacts, "supporter.contacts"),
    viewpoints: each(s.viewpoints, "supporter.viewpoints", vector),
  };
}

function unseen(value: unknown, where: string): Unseen {
  const u = record(value, where);
  return {
    object: number(u.object, `${where}.object`),
    shadow: number(u.shadow, `${where}.shadow`),
    supporter: number(u.supporter, `${where}.supporter`),
    object_view: vector(u.object_view, `${where}.object_view`),
    supporter_view: vector(u.supporter_view, `${where}.supporter_view`),
  };
}

function margin(value: unknown, where: string): Margin {
  const m = record(value, where);
  const of = (name: string) => number(m[name], `${where}.${name}`);
  return {
    tilts: numbers(m.tilts, `${where}.tilts`, 8),
    jolt_time: of("jolt_time"),
    tilted_sinking: of("tilted_sinking"),
    escape_rise: of("escape_rise"),
    centre_of_mass_radius: of("centre_of_mass_radius"),
    escape_ratio: of("escape_ratio"),
    knock_speed: of("knock_speed"),
  };
}

function path(value: unknown, where: string): Path {
  const p = record(value, where);
  const waypoints = each(p.waypoints, `${where}.waypoints`, waypoint);
  const release = number(p.release, `${where}.release`);
  if (!waypoints[release])
    throw new SceneError(`${where}.release`, `is ${release}, but there are ${waypoints.length} waypoints`);
  return {
    waypoints,
    release,
    gripper: each(p.gripper, `${where}.gripper`, waypoint),
    clearance: orNull(p.clearance, `${where}.clearance`, number),
  };
}

function hangingPose(value: unknown, where: string): HangingPose {
  const p = record(value, where);
  const maybe = <T>(name: string, read: (value: unknown, where: string) => T) =>
    orNull(p[name], `${where}.${name}`, read);
  return {
    rank: number(p.rank, `${where}.rank`),
    release: pose(p.release, `${where}.release`),
    rest: maybe("rest", pose),
    kind: maybe("kind", text),
    probability: maybe("probability", number),
    robustness: maybe("robustness", number),
    sinking: maybe("sinking", number),
    clearance: maybe("clearance", number),
    tolerance: maybe("tolerance", (t, at) => ({
      position: number(record(t, at).position, `${at}.position`),
      rotation: number(record(t, at).rotation, `${at}.rotation`),
    })),
    unseen: maybe("unseen", unseen),
    margin: maybe("margin", margin),
    contacts:
      maybe("contacts", (contacts, at) =>
        each(contacts, at, (c, one) => ({
          position: vector(record(c, one).position, `${one}.position`),
          normal: vector(record(c, one).normal, `${one}.normal`),
          force: number(record(c, one).force, `${one}.force`),
        })),
      ) ?? [],
    motion: maybe("motion", motion) ?? [],
    path: maybe("path", path),
    pathFailure: maybe("path_failure", (f, at) => text(record(f, at).message, `${at}.message`)),
  };
}

/** Reads the scene; throws an error that names the place of the first thing that is wrong. */
export function readScene(json: string): Scene {
  let parsed: unknown;
  try {
    parsed = JSON.parse(json);
  } catch (error) {
    throw new SceneError("the scene", `is not JSON: ${(error as Error).message}`);
  }
  const s = record(parsed, "the scene");
  if (s.schema !== SCHEMA) throw new SceneError("schema", `is ${String(s.schema)}, but this page reads ${SCHEMA}`);
  const all = (value: unknown, where: string, names: string[]) =>
    Object.fromEntries(names.map((name) => [name, number(record(value, where)[name], `${where}.${name}`)]));
  return {
    version: text(s.version, "version"),
    mostTilt: orNull(s.most_tilt, "most_tilt", number) ?? MOST_TILT,
    object: object(s.object),
    supporter: supporter(s.supporter),
    obstacles: floats(s.obstacles, "obstacles", 3),
    gripper: orNull(s.gripper, "gripper", (g, where) => ({
      parts: each(record(g, where).parts, `${where}.parts`, (p, at) => ({
        from: vector(record(p, at).from, `${at}.from`),
        to: vector(record(p, at).to, `${at}.to`),
        radius: number(record(p, at).radius, `${at}.radius`),
        opening: vector(record(p, at).opening, `${at}.opening`),
      })),
      retreat: vector(record(g, where).retreat, `${where}.retreat`),
    })),
    poses: each(s.poses, "poses", hangingPose),
    fallen: each(s.fallen ?? [], "fallen", (f, where) => ({
      fate: text(record(f, where).fate, `${where}.fate`),
      release: pose(record(f, where).release, `${where}.release`),
      motion: motion(record(f, where).motion, `${where}.motion`),
    })),
    counts: orNull(s.counts, "counts", (c, where) =>
      all(c, where, ["released", "at_rest", "rotated_off", "slid_off", "moving"]),
    ) as Counts | null,
    rejection: orNull(s.rejection, "rejection", (r, where) => ({
      stage: text(record(r, where).stage, `${where}.stage`),
      reason: text(record(r, where).reason, `${where}.reason`),
    })),
    seconds: orNull(s.seconds, "seconds", (t, where) =>
      all(t, where, ["object", "supporter", "matching"]),
    ) as Scene["seconds"],
  };
}
