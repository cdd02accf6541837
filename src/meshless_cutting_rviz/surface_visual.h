// The Ogre objects of a surface: two renderables (faces, wires) that share their buffers.
#pragma once

#include <OGRE/OgreColourValue.h>
#include <OGRE/OgreMaterial.h>
#include <OGRE/OgreQuaternion.h>
#include <OGRE/OgreVector3.h>
#include <meshless_cutting/SurfacePositions.h>
#include <meshless_cutting/SurfaceTopology.h>

#include <array>
#include <memory>
#include <vector>

#include "drawn_mesh.h"

namespace Ogre {
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace meshless_cutting {

class TriangleRenderable;

/// What a SurfaceDisplay lets the user choose.
struct SurfaceLook {
  bool faces = true;
  bool wires = false;
  bool at_rest = false;    // draw the rest positions, where the object was when the session began
  bool fragments = false;  // a colour per fragment instead of one per region
  float alpha = 1;
  Ogre::ColourValue skin, cut_face, wire;
};

class SurfaceVisual {
 public:
  SurfaceVisual(Ogre::SceneManager* scene_manager, Ogre::SceneNode* parent);
  ~SurfaceVisual();

  void SetLook(const SurfaceLook& look);
  /// Must have passed SurfaceMatcher: sizes fit, all is finite. Indices are uploaded only when `topology` is another
  /// message than the last one.
  void SetSurface(const SurfaceTopologyConstPtr& topology, const SurfacePositionsConstPtr& positions);
  /// Draws nothing until the next surface.
  void Clear();
  /// Pose of the scene frame in rviz' fixed frame.
  void SetPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);

 private:
  void Redraw(bool indices);
  void UpdateColours();
  void UpdateMaterials();

  Ogre::SceneManager* scene_manager_;
  Ogre::SceneNode* node_;  // scene frame
  Ogre::SceneNode* surface_node_;
  Ogre::MaterialPtr face_material_, wire_material_;
  std::unique_ptr<TriangleRenderable> faces_, wires_;

  SurfaceLook look_;
  SurfaceTopologyConstPtr topology_;
  SurfacePositionsConstPtr positions_;
  DrawnMesh mesh_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<Ogre::ColourValue> colours_;  // per drawn vertex, without light
};

/// The colour of a fragment: 0, the largest, keeps `largest`; the others take turns through eight that differ well.
Ogre::ColourValue FragmentColour(std::uint32_t fragment, const Ogre::ColourValue& largest);

}  // namespace meshless_cutting
