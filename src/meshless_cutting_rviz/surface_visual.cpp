#include "surface_visual.h"

#include <OGRE/OgreMaterialManager.h>
#include <OGRE/OgreResourceGroupManager.h>
#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreTechnique.h>
#include <rviz/ogre_helpers/compatibility.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "triangle_renderable.h"

namespace meshless_cutting {
namespace {

constexpr float kCreaseAngle = 0.8f;  // rad: a box has edges, an organ has none

// The only lamp of rviz is at the camera and makes no gloss: relief is flat in it. A brighter sky and the gloss of a
// wet surface under a lamp at the surgeon's left shoulder are put into the colours.
Ogre::ColourValue Lit(const Ogre::ColourValue& colour, const std::array<float, 3>& n) {
  constexpr float kHalf[3] = {-0.20f, -0.76f, 0.62f};  // between lamp and eye, unit
  const float towards = std::max(0.0f, n[0] * kHalf[0] + n[1] * kHalf[1] + n[2] * kHalf[2]);
  const float gloss = 0.25f * std::pow(towards, 40.0f);
  Ogre::ColourValue lit = colour * (0.88f + 0.12f * n[2]) + Ogre::ColourValue(gloss, gloss, gloss);
  lit.a = colour.a;
  return lit.saturateCopy();
}

Ogre::MaterialPtr NewMaterial(const std::string& what) {
  static std::atomic<int> count{0};  // names are global in Ogre
  const std::string name = "meshless_cutting/" + what + std::to_string(count++);
  Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create(name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  material->setReceiveShadows(false);
  material->getTechnique(0)->setLightingEnabled(true);
  return material;
}

}  // namespace

Ogre::ColourValue FragmentColour(std::uint32_t fragment, const Ogre::ColourValue& largest) {
  if (fragment == 0) return largest;
  static const std::array<std::array<float, 3>, 8> colours = {{{0.12f, 0.47f, 0.71f},
                                                               {0.17f, 0.63f, 0.17f},
                                                               {1.00f, 0.50f, 0.05f},
                                                               {0.58f, 0.40f, 0.74f},
                                                               {0.09f, 0.75f, 0.81f},
                                                               {0.89f, 0.47f, 0.76f},
                                                               {0.74f, 0.74f, 0.13f},
                                                               {0.50f, 0.50f, 0.50f}}};
  const auto& c = colours[(fragment - 1) % colours.size()];
  return Ogre::ColourValue(c[0], c[1], c[2], 1);
}

SurfaceVisual::SurfaceVisual(Ogre::SceneManager* scene_manager, Ogre::SceneNode* parent)
    : scene_manager_(scene_manager),
      node_(parent->createChildSceneNode()),
      surface_node_(node_->createChildSceneNode()),
      face_material_(NewMaterial("faces")),
      wire_material_(NewMaterial("wires")) {
  const auto buffers = std::make_shared<TriangleBuffers>();
  faces_ = std::make_unique<TriangleRenderable>(buffers);
  wires_ = std::make_unique<TriangleRenderable>(buffers);
  rviz::setMaterial(*faces_, face_material_);
  rviz::setMaterial(*wires_, wire_material_);

  Ogre::Pass* faces = face_material_->getTechnique(0)->getPass(0);
  faces->setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
  Ogre::Pass* wires = wire_material_->getTechnique(0)->getPass(0);
  wires->setPolygonMode(Ogre::PM_WIREFRAME);
  wires->setDepthBias(1, 1);  // in front of the faces that they outline
  wires->setAmbient(0, 0, 0);
  wires->setDiffuse(0, 0, 0, 1);
  UpdateMaterials();
}

SurfaceVisual::~SurfaceVisual() {
  surface_node_->detachAllObjects();
  faces_.reset();
  wires_.reset();
  scene_manager_->destroySceneNode(surface_node_);
  scene_manager_->destroySceneNode(node_);
  Ogre::MaterialManager::getSingleton().remove(face_material_->getName());
  Ogre::MaterialManager::getSingleton().remove(wire_material_->getName());
}

void SurfaceVisual::SetLook(const SurfaceLook& look) {
  look_ = look;
  UpdateMaterials();
  if (!topology_) return;
  UpdateColours();
  Redraw(false);
}

void SurfaceVisual::UpdateMaterials() {
  Ogre::Pass* faces = face_material_->getTechnique(0)->getPass(0);
  const bool opaque = look_.alpha > 0.999f;
  faces->setSceneBlending(opaque ? Ogre::SBT_REPLACE : Ogre::SBT_TRANSPARENT_ALPHA);
  faces->setDepthWriteEnabled(opaque);
  wire_material_->getTechnique(0)->getPass(0)->setSelfIllumination(look_.wire);
}

void SurfaceVisual::UpdateColours() {
  colours_.resize(mesh_.vertex().size());
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const bool cut = mesh_.region()[i] == SurfaceTopology::CUT_FACE;
    Ogre::ColourValue colour = cut ? look_.cut_face : look_.skin;
    if (look_.fragments && mesh_.fragment()[i] > 0) colour = FragmentColour(mesh_.fragment()[i], colour);
    colour.a = look_.alpha;
    colours_[i] = colour;
  }
}

void SurfaceVisual::SetSurface(const SurfaceTopologyConstPtr& topology, const SurfacePositionsConstPtr& positions) {
  const bool changed = topology != topology_;
  if (changed) {
    mesh_ = DrawnMesh(*topology, kCreaseAngle);
    topology_ = topology;
    UpdateColours();
  }
  positions_ = positions;
  Redraw(changed);
}

void SurfaceVisual::Redraw(bool indices) {
  const std::vector<float>& xyz = look_.at_rest ? topology_->rest_positions : positions_->positions;
  mesh_.Normals(xyz, &normals_);
  std::vector<DrawnVertex> vertices(mesh_.vertex().size());
  Ogre::AxisAlignedBox box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const float* p = &xyz[3 * mesh_.vertex()[i]];
    const std::array<float, 3>& n = normals_[i];
    vertices[i] = {{p[0], p[1], p[2]}, {n[0], n[1], n[2]}, Lit(colours_[i], n).getAsABGR()};
    box.merge(Ogre::Vector3(p[0], p[1], p[2]));
  }
  if (indices) faces_->buffers().SetTriangles(mesh_.triangles());
  faces_->buffers().SetVertices(vertices);
  faces_->SetBounds(box);
  wires_->SetBounds(box);

  const auto& p = topology_->rest_pose.position;
  const auto& q = topology_->rest_pose.orientation;
  const Ogre::Quaternion rest(static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                              static_cast<float>(q.z));
  const bool placed = look_.at_rest && rest.Norm() > 0.5f;  // a message that was filled by hand may leave it zero
  surface_node_->setPosition(
      placed ? Ogre::Vector3(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z))
             : Ogre::Vector3::ZERO);
  surface_node_->setOrientation(placed ? rest : Ogre::Quaternion::IDENTITY);

  surface_node_->detachAllObjects();
  if (vertices.empty()) return;
  if (look_.faces) surface_node_->attachObject(faces_.get());
  if (look_.wires) surface_node_->attachObject(wires_.get());
}

void SurfaceVisual::Clear() {
  surface_node_->detachAllObjects();
  topology_.reset();
  positions_.reset();
}

void SurfaceVisual::SetPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

}  // namespace meshless_cutting
