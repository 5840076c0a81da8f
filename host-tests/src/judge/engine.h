// What a judge asks of a physics engine: one rigid body among fixed shapes. Metres, kilograms, seconds; the body's frame
// is the frame of its principal axes about its centre of mass. Mirrored in world.rs.
#pragma once
#include <cstddef>
#include <cstdint>

extern "C" {

struct Setup {
    double mass;
    double inertia[3];  // about the principal axes
    double friction;
    double time_step;
    double damping;  // of rotation, per second
};

struct State {
    double position[3];
    double rotation[4];  // x, y, z, w
    double velocity[3];  // of the centre of mass
    double spin[3];      // in world coordinates
};

// Shapes are given in the body's frame if `body`, in the world's if not. Everything is copied.
struct Engine {
    void* (*create)(const Setup*);
    void (*add_hull)(void*, bool body, const double* points, size_t count);  // null: add_mesh instead
    void (*add_capsule)(void*, bool body, const double* from, const double* to, double radius);
    void (*add_box)(void*, bool body, const double* centre, const double* axes, const double* half_extents);
    void (*add_mesh)(void*, bool body, const double* vertices, size_t vertex_count, const uint32_t* triangles,
                     size_t triangle_count);  // null: add_hull instead
    void (*place)(void*, const State*);       // forgets every contact
    void (*pull)(void*, const double* gravity);
    uint32_t (*step)(void*, uint32_t count);  // in how many of the steps something bore on the body
    void (*read)(void*, State*);
    double (*penetration)(void*);  // the deepest, here and now; 0 when nothing overlaps
    void (*destroy)(void*);
};
}
