#include "triangle_renderable.h"

#include <OGRE/OgreCamera.h>
#include <OGRE/OgreHardwareBufferManager.h>
#include <OGRE/OgreRenderOperation.h>
#include <OGRE/OgreSceneNode.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace meshless_cutting {
namespace {

std::size_t WithReserve(std::size_t count) { return count + count / 4 + 64; }

}  // namespace

TriangleBuffers::TriangleBuffers()
    : vertex_data_(std::make_unique<Ogre::VertexData>()), index_data_(std::make_unique<Ogre::IndexData>()) {
  Ogre::VertexDeclaration* layout = vertex_data_->vertexDeclaration;
  layout->addElement(0, offsetof(DrawnVertex, position), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout->addElement(0, offsetof(DrawnVertex, normal), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout->addElement(0, offsetof(DrawnVertex, colour), Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
}

TriangleBuffers::~TriangleBuffers() = default;

void TriangleBuffers::SetTriangles(const std::vector<std::uint32_t>& indices) {
  if (indices.size() > index_capacity_) {
    index_capacity_ = WithReserve(indices.size());
    index_data_->indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
        Ogre::HardwareIndexBuffer::IT_32BIT, index_capacity_, Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY);
  }
  if (!indices.empty()) {
    index_data_->indexBuffer->writeData(0, indices.size() * sizeof(std::uint32_t), indices.data(), true);
  }
  index_data_->indexCount = indices.size();
}

void TriangleBuffers::SetVertices(const std::vector<DrawnVertex>& vertices) {
  if (vertices.size() > vertex_capacity_) {
    vertex_capacity_ = WithReserve(vertices.size());
    vertices_ = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
        sizeof(DrawnVertex), vertex_capacity_, Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
    vertex_data_->vertexBufferBinding->setBinding(0, vertices_);
  }
  if (!vertices.empty()) vertices_->writeData(0, vertices.size() * sizeof(DrawnVertex), vertices.data(), true);
  vertex_data_->vertexCount = vertices.size();
}

TriangleRenderable::TriangleRenderable(std::shared_ptr<TriangleBuffers> buffers) : buffers_(std::move(buffers)) {
  mRenderOp.operationType = Ogre::RenderOperation::OT_TRIANGLE_LIST;
  mRenderOp.useIndexes = true;
  mRenderOp.vertexData = buffers_->vertex_data();
  mRenderOp.indexData = buffers_->index_data();
}

void TriangleRenderable::SetBounds(const Ogre::AxisAlignedBox& box) {
  setBoundingBox(box);
  if (getParentSceneNode()) getParentSceneNode()->needUpdate();
}

Ogre::Real TriangleRenderable::getBoundingRadius() const {
  return mBox.isFinite() ? std::sqrt(std::max(mBox.getMaximum().squaredLength(), mBox.getMinimum().squaredLength()))
                         : 0;
}

Ogre::Real TriangleRenderable::getSquaredViewDepth(const Ogre::Camera* camera) const {
  const Ogre::Vector3 centre = mBox.isFinite() ? mBox.getCenter() : Ogre::Vector3::ZERO;
  const Ogre::Vector3 here = getParentSceneNode() ? getParentSceneNode()->convertLocalToWorldPosition(centre) : centre;
  return (camera->getDerivedPosition() - here).squaredLength();
}

}  // namespace meshless_cutting
