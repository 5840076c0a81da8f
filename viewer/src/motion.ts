// Motions over time: what the slider runs through.

import { Matrix4, Quaternion, Vector3 } from "three";
import type { Fallen, HangingPose, Pose, Scene, Waypoint } from "./scene";

const ONE = new Vector3(1, 1, 1);

/** How long the gripper is shown to open, seconds. The path has no time for it. */
const OPENING = 0.6;

/** How long a release is shown for which the page has no simulated motion, seconds. */
const UNSIMULATED = 1;

/** Time from the last pose of a simulated motion to the exact rest pose, seconds: shorter than can be seen. */
const TO_REST = 0.02;

export function matrixOf({ position, quaternion_xyzw }: Pose): Matrix4 {
  return new Matrix4().compose(new Vector3(...position), new Quaternion(...quaternion_xyzw).normalize(), ONE);
}

/** Poses over time. In between, the pivot moves in a straight line and the object turns about it by slerp, as in a path. */
export class Track {
  readonly start: number;
  readonly end: number;
  private readonly rotations: Quaternion[];
  private readonly pivots: Vector3[];

  constructor(
    private readonly keys: readonly Waypoint[],
    private readonly pivot: Vector3,
  ) {
    this.rotations = keys.map((key) => new Quaternion(...key.quaternion_xyzw).normalize());
    this.pivots = keys.map((key, i) =>
      pivot
        .clone()
        .applyQuaternion(this.rotations[i]!)
        .add(new Vector3(...key.position)),
    );
    this.start = keys[0]?.seconds ?? 0;
    this.end = keys[keys.length - 1]?.seconds ?? 0;
  }

  /** Where the pivot goes. */
  get line(): readonly Vector3[] {
    return this.pivots;
  }

  at(seconds: number): Matrix4 {
    let after = this.keys.findIndex((key) => key.seconds >= seconds);
    if (after < 0) after = this.keys.length - 1;
    const before = Math.max(after - 1, 0);
    const [from, to] = [this.keys[before]!.seconds, this.keys[after]!.seconds];
    const share = to > from ? Math.min(Math.max((seconds - from) / (to - from), 0), 1) : 1;
    const rotation = this.rotations[before]!.clone().slerp(this.rotations[after]!, share);
    const pivot = this.pivots[before]!.clone().lerp(this.pivots[after]!, share);
    return new Matrix4().compose(pivot.sub(this.pivot.clone().applyQuaternion(rotation)), rotation, ONE);
  }
}

/** A stretch of a sequence, from the end of the one before it. */
export interface Phase {
  name: string;
  until: number;
}

export interface Sequence {
  name: "release" | "path" | "fall";
  /** One sentence on what it shows. */
  about: string;
  duration: number;
  phases: Phase[];
  object: Track;
  /** The gripper, if it is to be seen. */
  gripper: ((seconds: number) => { matrix: Matrix4; opening: number }) | null;
  /** When the object has come to rest, and the contact forces act. */
  rests: (seconds: number) => boolean;
}

function same(a: Pose, b: Pose): boolean {
  const turn = Math.abs(a.quaternion_xyzw.reduce((sum, q, i) => sum + q * b.quaternion_xyzw[i]!, 0));
  return Math.hypot(...a.position.map((p, i) => p - b.position[i]!)) < 1e-7 && turn > 1 - 1e-12;
}

function distance(a: Pose, b: Pose): number {
  return Math.hypot(...a.position.map((p, i) => p - b.position[i]!));
}

export function releaseOf(pose: HangingPose, scene: Scene): Sequence {
  const keys = [...pose.motion];
  let about = "Release to rest: the simulated motion";
  if (keys.length === 0) {
    keys.push({ ...pose.release, seconds: 0 });
    if (pose.rest) keys.push({ ...pose.rest, seconds: UNSIMULATED });
    about = pose.rest ? "Release to rest: a straight line, not a simulation" : "The pose of the published method";
  } else if (pose.rest && !same(keys[keys.length - 1]!, pose.rest)) {
    keys.push({ ...pose.rest, seconds: keys[keys.length - 1]!.seconds + TO_REST });
  }
  const object = new Track(keys, new Vector3(...scene.object.centreOfMass));
  const duration = object.end;
  return {
    name: "release",
    about,
    duration,
    object,
    gripper: null,
    phases: [{ name: pose.rest ? "Release to rest" : "Pose", until: duration }],
    rests: (seconds) => seconds >= duration - 1e-6,
  };
}

export function fallOf(fallen: Fallen, scene: Scene): Sequence {
  const keys = fallen.motion.length > 0 ? fallen.motion : [{ ...fallen.release, seconds: 0 }];
  const object = new Track(keys, new Vector3(...scene.object.centreOfMass));
  return {
    name: "fall",
    about: "Release and fall: the simulated motion",
    duration: object.end,
    object,
    gripper: null,
    phases: [{ name: "Fall", until: object.end }],
    rests: () => false,
  };
}

/** The path of the object, and of the gripper that opens and leaves; or, to take the object off, the other way. */
export function pathOf(pose: HangingPose, scene: Scene): Sequence | null {
  const path = pose.path;
  if (!path) return null;
  const { waypoints } = path;
  const [first, last] = [waypoints[0]!, waypoints[waypoints.length - 1]!];
  const hung = pose.rest ?? pose.release;
  const takesOff = distance(first, hung) < distance(last, hung);
  const parts = scene.gripper?.parts ?? [];
  const opens = parts.length > 0 && parts.some((part) => Math.hypot(...part.opening) > 0);
  const pause = opens ? OPENING : 0;
  const pivotOfGripper = new Vector3();
  for (const { from, to } of parts) {
    pivotOfGripper.add(new Vector3(...from)).add(new Vector3(...to));
  }
  pivotOfGripper.multiplyScalar(parts.length > 0 ? 0.5 / parts.length : 1);

  const release = waypoints[path.release]!.seconds;
  const shift = takesOff ? pause : 0;
  const object = new Track(
    waypoints.map((key) => ({ ...key, seconds: key.seconds + shift })),
    new Vector3(...scene.object.centreOfMass),
  );
  const alone =
    path.gripper.length > 0
      ? new Track(
          path.gripper.map((key) => ({ ...key, seconds: key.seconds + (takesOff ? 0 : pause) })),
          pivotOfGripper,
        )
      : null;
  const phases: Phase[] = takesOff
    ? [
        { name: "Gripper approaches", until: alone?.end ?? 0 },
        { name: "Gripper closes", until: object.start },
        { name: "Lift off", until: release + shift },
        { name: "Leave", until: object.end },
      ]
    : [
        { name: "Approach", until: release },
        { name: "Lower to rest", until: object.end },
        { name: "Gripper opens", until: object.end + pause },
        { name: "Gripper leaves", until: alone?.end ?? object.end + pause },
      ];
  const shown = phases.filter((phase, i) => phase.until > (phases[i - 1]?.until ?? 0) + 1e-6);
  const gripper = (seconds: number) => {
    if (takesOff) {
      const opening = pause > 0 ? Math.min(Math.max((object.start - seconds) / pause, 0), 1) : 0;
      return { matrix: alone && seconds < alone.end ? alone.at(seconds) : object.at(seconds), opening };
    }
    const opening = pause > 0 ? Math.min(Math.max((seconds - object.end) / pause, 0), 1) : 0;
    return { matrix: alone && seconds > alone.start ? alone.at(seconds) : object.at(seconds), opening };
  };
  return {
    name: "path",
    about: takesOff ? "The planned path off the supporter" : "The planned path from the start to rest",
    duration: Math.max(object.end, phases[phases.length - 1]!.until),
    phases: shown,
    object,
    gripper: parts.length > 0 ? gripper : null,
    rests: (seconds) => (takesOff ? seconds <= object.start + 1e-6 : seconds >= object.end - 1e-6),
  };
}

/** Length of a line, metres. */
export function lengthOf(line: readonly Vector3[]): number {
  return line.reduce((sum, point, i) => sum + (i > 0 ? point.distanceTo(line[i - 1]!) : 0), 0);
}
