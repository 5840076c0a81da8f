// The horizontal axes of the supporter, from which the directions of the tilts are counted.

import { Vector3 } from "three";

/**
 * `ahead` is the supporter's x axis, or y where x is vertical, made horizontal; `aside` is a quarter turn counter-clockwise
 * from it, seen from above.
 */
export function axesOf(up: Vector3): { ahead: Vector3; aside: Vector3 } {
  const along = Math.abs(up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const ahead = along.addScaledVector(up, -along.dot(up)).normalize();
  return { ahead, aside: up.clone().cross(ahead) };
}

/** The name of the coordinate axis that a direction is along, such as "−y", or null. */
export function nameOf(direction: Vector3): string | null {
  const names = ["x", "y", "z"].map((name, i) => [name, direction.getComponent(i)] as const);
  const best = names.find(([, share]) => Math.abs(share) > 0.999);
  return best ? `${best[1] > 0 ? "+" : "−"}${best[0]}` : null;
}
