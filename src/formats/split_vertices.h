// Vertices of meshes whose corners have more than a position.
#ifndef SHEAF_FORMATS_SPLIT_VERTICES_H_
#define SHEAF_FORMATS_SPLIT_VERTICES_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sheaf {

// Corners of one position with equal keys are one vertex: those of a position form a chain.
template <typename Key>
class VertexSplitter {
 public:
  // Of positions below `count`.
  explicit VertexSplitter(std::size_t count) : latest_(count, kNone) {}

  // The corner's vertex, and whether it is new. Vertices count from 0 in the order in which they
  // come.
  std::pair<std::uint32_t, bool> Find(std::size_t position, const Key& key) {
    for (std::uint32_t i = latest_[position]; i != kNone; i = vertices_[i].previous) {
      if (vertices_[i].key == key) return {i, false};
    }
    const auto vertex = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back({key, position, latest_[position]});
    latest_[position] = vertex;
    return {vertex, true};
  }

  // Begins the next mesh. Only what this one touched is cleared: there may be many of a few faces.
  void Clear() {
    for (const Vertex& vertex : vertices_) latest_[vertex.position] = kNone;
    vertices_.clear();
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Vertex {
    Key key;
    std::size_t position;
    std::uint32_t previous;  // of the same position
  };
  std::vector<std::uint32_t> latest_;  // by position
  std::vector<Vertex> vertices_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SPLIT_VERTICES_H_
