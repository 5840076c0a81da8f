// A ring and a peg for the examples that read no files.
#ifndef SHAPES_H
#define SHAPES_H

#include <math.h>
#include <stdint.h>

enum {
  RING_ROWS = 48,
  RING_COLUMNS = 16,
  RING_VERTICES = RING_ROWS * RING_COLUMNS,
  RING_TRIANGLES = 2 * RING_VERTICES
};
enum { PEG_ROWS = 80, PEG_COLUMNS = 30, PEG_POINTS = PEG_ROWS * PEG_COLUMNS };

static inline float turn(uint32_t step, uint32_t steps) { return 6.2831853f * (float)step / (float)steps; }

// A ring around the z axis, 6 mm thick; `radius` of its centre line in metres. Writes RING_VERTICES rows and
// RING_TRIANGLES rows.
static inline void make_ring(float radius, float (*vertices)[3], uint32_t (*triangles)[3]) {
  for (uint32_t row = 0; row < RING_ROWS; ++row) {
    for (uint32_t column = 0; column < RING_COLUMNS; ++column, ++vertices, triangles += 2) {
      const float around = turn(row, RING_ROWS), across = turn(column, RING_COLUMNS);
      const float r = radius + 0.003f * cosf(across);
      (*vertices)[0] = r * cosf(around);
      (*vertices)[1] = r * sinf(around);
      (*vertices)[2] = 0.003f * sinf(across);
      const uint32_t here = row * RING_COLUMNS, next = (row + 1) % RING_ROWS * RING_COLUMNS;
      const uint32_t right = (column + 1) % RING_COLUMNS;
      const uint32_t corners[2][3] = {{here + column, next + column, next + right},
                                      {here + column, next + right, here + right}};
      for (int k = 0; k < 6; ++k) triangles[k / 3][k % 3] = corners[k / 3][k % 3];
    }
  }
}

// A peg along the y axis, 8 cm long; `radius` in metres. Writes PEG_POINTS rows of points and of normals.
static inline void make_peg(float radius, float (*points)[3], float (*normals)[3]) {
  for (uint32_t row = 0; row < PEG_ROWS; ++row) {
    for (uint32_t column = 0; column < PEG_COLUMNS; ++column, ++points, ++normals) {
      const float around = turn(column, PEG_COLUMNS);
      (*normals)[0] = sinf(around);
      (*normals)[1] = 0.0f;
      (*normals)[2] = cosf(around);
      (*points)[0] = radius * sinf(around);
      (*points)[1] = 0.001f * (float)row;
      (*points)[2] = radius * cosf(around);
    }
  }
}

#endif
