// Triangles in a dynamic vertex buffer.
#pragma once

#include <OGRE/OgreHardwareIndexBuffer.h>
#include <OGRE/OgreHardwareVertexBuffer.h>
#include <OGRE/OgreRenderOperation.h>
#include <OGRE/OgreSimpleRenderable.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace meshless_cutting {

/// A vertex as it lies in the buffer.
struct DrawnVertex {
  float position[3];
  float normal[3];
  std::uint32_t colour;  // bytes red, green, blue, alpha
};

/// Buffers that several renderables draw. They grow by a quarter when they are too small, as a cut adds vertices.
class TriangleBuffers {
 public:
  TriangleBuffers();
  ~TriangleBuffers();
  TriangleBuffers(const TriangleBuffers&) = delete;
  TriangleBuffers& operator=(const TriangleBuffers&) = delete;

  void SetTriangles(const std::vector<std::uint32_t>& indices);
  void SetVertices(const std::vector<DrawnVertex>& vertices);

  Ogre::VertexData* vertex_data() { return vertex_data_.get(); }
  Ogre::IndexData* index_data() { return index_data_.get(); }

 private:
  std::unique_ptr<Ogre::VertexData> vertex_data_;
  std::unique_ptr<Ogre::IndexData> index_data_;
  Ogre::HardwareVertexBufferSharedPtr vertices_;
  std::size_t vertex_capacity_ = 0;
  std::size_t index_capacity_ = 0;
};

class TriangleRenderable : public Ogre::SimpleRenderable {
 public:
  explicit TriangleRenderable(std::shared_ptr<TriangleBuffers> buffers);

  TriangleBuffers& buffers() { return *buffers_; }
  /// Box around all that is drawn; without it Ogre would not draw when it should.
  void SetBounds(const Ogre::AxisAlignedBox& box);

  Ogre::Real getBoundingRadius() const override;
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;

 private:
  std::shared_ptr<TriangleBuffers> buffers_;
};

}  // namespace meshless_cutting
