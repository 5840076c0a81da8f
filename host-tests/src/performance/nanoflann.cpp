// nanoflann's k-d tree over points in the caller's memory. Mirrored in nanoflann.rs.
#include <nanoflann.hpp>

#include <cstddef>
#include <cstdint>

namespace {

struct Points {
    const float* at;
    size_t count;
    size_t kdtree_get_point_count() const { return count; }
    float kdtree_get_pt(size_t index, size_t axis) const { return at[3 * index + axis]; }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, uint32_t>;

struct Index {
    Points points;
    Tree tree;
    Index(const float* at, size_t count) : points{at, count}, tree(3, points) {}
};

}  // namespace

extern "C" {

void* hangpose_nanoflann_create(const float* points, size_t count) { return new Index(points, count); }

void hangpose_nanoflann_destroy(void* index) { delete static_cast<Index*>(index); }

// Writes the `k` nearest points, nearest first, and the squares of their distances. Returns how many there are.
size_t hangpose_nanoflann_search(const void* index, const float* query, size_t k, uint32_t* found, float* squares) {
    return static_cast<const Index*>(index)->tree.knnSearch(query, k, found, squares);
}
}
