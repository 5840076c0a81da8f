// Where an object must be, computed from the JSON alone and without three.js. Matrices are row-major.

export function matrixOf({ position: [px, py, pz], quaternion_xyzw }) {
  const norm = Math.hypot(...quaternion_xyzw);
  const [x, y, z, w] = quaternion_xyzw.map((q) => q / norm);
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y - w * z),
    2 * (x * z + w * y),
    px,
    2 * (x * y + w * z),
    1 - 2 * (x * x + z * z),
    2 * (y * z - w * x),
    py,
    2 * (x * z - w * y),
    2 * (y * z + w * x),
    1 - 2 * (x * x + y * y),
    pz,
    0,
    0,
    0,
    1,
  ];
}

export function motionOf({ seconds, poses }) {
  const floats = (text) => {
    const bytes = Buffer.from(text, "base64");
    return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readFloatLE(4 * i));
  };
  const numbers = floats(poses);
  return floats(seconds).map((at, i) => ({
    seconds: at,
    position: numbers.slice(7 * i, 7 * i + 3),
    quaternion_xyzw: numbers.slice(7 * i + 3, 7 * i + 7),
  }));
}

/** Halfway between two poses: the pivot in the middle, the rotation by half of the angle. */
export function halfway(a, b, pivot) {
  const sign = a.quaternion_xyzw.reduce((sum, q, i) => sum + q * b.quaternion_xyzw[i], 0) < 0 ? -1 : 1;
  const rotation = matrixOf({
    position: [0, 0, 0],
    quaternion_xyzw: a.quaternion_xyzw.map((q, i) => q + sign * b.quaternion_xyzw[i]),
  });
  const [from, to, turned] = [apply(matrixOf(a), pivot), apply(matrixOf(b), pivot), apply(rotation, pivot)];
  return rotation.map((value, i) =>
    i % 4 === 3 && i < 12 ? (from[(i - 3) / 4] + to[(i - 3) / 4]) / 2 - turned[(i - 3) / 4] : value,
  );
}

export function apply(matrix, [x, y, z]) {
  return [0, 4, 8].map((row) => matrix[row] * x + matrix[row + 1] * y + matrix[row + 2] * z + matrix[row + 3]);
}
