// Interface of a physics engine: one rigid body among fixed shapes. Units are metres, kilograms and seconds. The body
// frame has its origin at the centre of mass and its axes along the principal axes. Mirrored in world.rs.
#pragma once
#include <cstddef>
#include <cstdint>

extern "C" {

struct Setup {
    double mass;
    double inertia[3];  // about the principal axes
    double friction;
    double time_step;
    double damping;  // rate for rotation, 1/s
};

struct State {
    double position[3];
    double rotation[4];  // x, y, z, w
    double velocity[3];  // of the centre of mass
    double spin[3];      // in world coordinates
};

// Shapes are in the body frame if `body`, otherwise in the world frame. All arguments are copied.
struct Engine {
    void* (*create)(const Setup*);
    void (*add_hull)(void*, bool body, const double* points, size_t count);  // null if add_mesh replaces it
    void (*add_capsule)(void*, bool body, const double* from, const double* to, double radius);
    void (*add_box)(void*, bool body, const double* centre, const double* axes, const double* half_extents);
    void (*add_mesh)(void*, bool body, const double* vertices, size_t vertex_count, const uint32_t* triangles,
                     size_t triangle_count);  // null if add_hull replaces it
    void (*place)(void*, const State*);       // discards all contacts
    void (*pull)(void*, const double* gravity);
    uint32_t (*step)(void*, uint32_t count);  // returns the number of steps with a loaded contact
    void (*read)(void*, State*);
    double (*penetration)(void*);  // largest depth at the current pose; 0 without overlap
    void (*destroy)(void*);
};
}
