#include "scene/scene_sections.h"

#include <cmath>
#include <map>

namespace meshless_cutting {
namespace {

// Physical limits wide enough for every tissue and organ; outside of them a unit is wrong.
const NumberRange kSize = {1e-5, 10, false, false};  // m

PronyBranch ReadPronyBranch(const YamlValue& value) {
  const YamlSection section(value, {"modulus_ratio", "relaxation_time_s"});
  PronyBranch branch;
  branch.modulus_ratio = section.Get("modulus_ratio")
                             .Number({0, 100, true, false}, "stiffness of the branch over that of the relaxed material");
  branch.relaxation_time_s = section.Get("relaxation_time_s").Number({1e-4, 1e6, false, false}, "in s");
  return branch;
}

double ReadFriction(const YamlSection& section) {
  const auto friction = section.Find("friction");
  return friction ? friction->Number(NumberRange::Closed(0, 10), "Coulomb's coefficient") : 0;
}

}  // namespace

std::vector<std::string> ObjectKeys() {
  return {"name",     "mesh",  "primitive",  "scale", "pose",    "cell_size_m", "lattice_size_m",
          "material", "fixed", "prescribed", "loads", "regions", "slits",       "support_radius_cells",
          "stabilisation"};
}

MaterialConfig ReadMaterial(const YamlValue& value) {
  const YamlSection section(value, {"model", "youngs_modulus_pa", "poisson_ratio", "density_kg_m3", "prony"});
  MaterialConfig material;
  if (const auto model = section.Find("model")) {
    const std::map<std::string, MaterialModel> models = {{"stable_neo_hookean", MaterialModel::kStableNeoHookean},
                                                         {"neo_hookean", MaterialModel::kNeoHookean},
                                                         {"st_venant_kirchhoff", MaterialModel::kStVenantKirchhoff},
                                                         {"linear", MaterialModel::kLinear}};
    const auto found = models.find(model->Text());
    if (found == models.end()) model->Fail("stable_neo_hookean, neo_hookean, st_venant_kirchhoff or linear");
    material.model = found->second;
  }
  material.youngs_modulus_pa =
      section.Get("youngs_modulus_pa").Number({1, 1e12, false, false}, "in Pa: soft tissue has 500 to 100000");
  material.poisson_ratio =
      section.Get("poisson_ratio")
          .Number(NumberRange::Open(-1, 0.5), "0.5 would be incompressible; take 0.45 to 0.49 for tissue");
  material.density_kg_m3 =
      section.Get("density_kg_m3").Number({1, 1e5, false, false}, "in kg/m^3: tissue has about 1050");
  if (const auto prony = section.Find("prony")) {
    for (const YamlValue& item : prony->List()) material.prony.push_back(ReadPronyBranch(item));
  }
  return material;
}

std::string ReadFrameId(const YamlValue& value) {
  const std::string frame = value.Text();
  if (frame.front() == '/' || frame.find_first_of(" \t") != std::string::npos) {
    value.Fail("a frame id without leading slash and without spaces");
  }
  return frame;
}

Eigen::Quaterniond ReadOrientation(const YamlValue& value) {
  const std::vector<double> xyzw = value.Numbers(4, "x, y, z, w");
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!(std::abs(q.norm() - 1) < 0.1)) value.Fail("a unit quaternion x, y, z, w; [0, 0, 0, 1] is no rotation");
  return q.normalized();
}

Eigen::Isometry3d ReadPose(const YamlValue& value) {
  const YamlSection section(value, {"position_m", "orientation_xyzw"});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (const auto position = section.Find("position_m")) pose.translation() = position->Vector3();
  if (const auto orientation = section.Find("orientation_xyzw")) {
    pose.linear() = ReadOrientation(*orientation).toRotationMatrix();
  }
  return pose;
}

Box ReadBox(const YamlValue& value, const std::vector<std::string>& more_keys) {
  std::vector<std::string> keys = {"min", "max"};
  keys.insert(keys.end(), more_keys.begin(), more_keys.end());
  const YamlSection section(value, keys);
  const YamlValue max = section.Get("max");
  const Box box{section.Get("min").Vector3(), max.Vector3()};
  if (!(box.min.array() < box.max.array()).all()) {
    max.Fail("each coordinate above that of `min`, " + Quote(section.Get("min").node()));
  }
  return box;
}

ObjectConfig ReadObject(const YamlValue& value) {
  const YamlSection section(value, ObjectKeys());
  ObjectConfig object;
  object.name = section.Get("name").Text();
  if (const auto scale = section.Find("scale")) {
    object.scale = scale->Number({1e-9, 1e9, false, false}, "metres per unit of the mesh, e.g. 0.001 for millimetres");
  }
  if (const auto pose = section.Find("pose")) object.T_WO = ReadPose(*pose);
  object.cell_size_m = section.Get("cell_size_m").Number(kSize, "in metres");
  const YamlValue lattice_size = section.Get("lattice_size_m");
  object.lattice_size_m = lattice_size.Number(kSize, "in metres");
  if (object.lattice_size_m > object.cell_size_m) {
    lattice_size.Fail("at most cell_size_m, " + Quote(section.Get("cell_size_m").node()) + "; half of it is usual");
  }
  object.material = ReadMaterial(section.Get("material"));
  if (const auto fixed = section.Find("fixed")) {
    for (const YamlValue& item : fixed->List()) object.fixed.push_back(ReadFixed(item));
  }
  if (const auto list = section.Find("prescribed")) {
    for (const YamlValue& item : list->List()) object.prescribed.push_back(ReadPrescribed(item));
  }
  if (const auto list = section.Find("loads")) {
    for (const YamlValue& item : list->List()) object.loads.push_back(ReadLoad(item));
  }
  if (const auto list = section.Find("regions")) {
    for (const YamlValue& item : list->List()) object.regions.push_back(ReadMaterialRegion(item));
  }
  if (const auto list = section.Find("slits")) {
    for (const YamlValue& item : list->List()) object.slits.push_back(ReadSlit(item));
  }
  if (const auto support = section.Find("support_radius_cells")) {
    object.support_radius_cells = support->Number({0.87, 2, false, false}, "0.9 takes the 8 particles around a cell");
  }
  if (const auto stabilisation = section.Find("stabilisation")) {
    object.stabilisation = stabilisation->Number(NumberRange::Closed(0.01, 10), "1.75 gives the smallest errors over the reference problems");
  }
  if (section.ExactlyOneOf({"mesh", "primitive"}) == "primitive") {
    if (const auto scale = section.Find("scale")) scale->Fail("no scale beside a primitive, whose sizes are metres");
    object.primitive = ReadPrimitive(section.Get("primitive"));
  }
  return object;
}

ObstacleConfig ReadObstacle(const YamlValue& value) {
  const YamlSection section(value, {"plane", "box_m", "urdf_link"});
  ObstacleConfig obstacle;
  if (section.ExactlyOneOf({"plane", "box_m", "urdf_link"}) == "plane") {
    const YamlSection plane(section.Get("plane"), {"point_m", "normal", "friction"});
    PlaneObstacle shape;
    shape.point = plane.Get("point_m").Vector3();
    const YamlValue normal = plane.Get("normal");
    shape.normal = normal.Vector3();
    if (!(shape.normal.norm() > 1e-6)) normal.Fail("a direction that is not zero; it points to where tissue may be");
    shape.normal.normalize();
    obstacle.shape = shape;
    obstacle.friction = ReadFriction(plane);
    return obstacle;
  }
  const YamlValue box_value = section.Get("box_m");
  const Box box = ReadBox(box_value, {"pose", "friction"});
  const YamlSection box_section(box_value, {"min", "max", "pose", "friction"});
  BoxObstacle shape;
  shape.half_extents = 0.5 * (box.max - box.min);
  if (const auto pose = box_section.Find("pose")) shape.T_WB = ReadPose(*pose);
  shape.T_WB.translate(Eigen::Vector3d(0.5 * (box.min + box.max)));
  obstacle.shape = shape;
  obstacle.friction = ReadFriction(box_section);
  return obstacle;
}

LinkObstacle ReadLinkObstacle(const YamlValue& value) {
  const YamlValue link = YamlSection(value, {"urdf_link"}).Get("urdf_link");
  const YamlSection section(link, {"link", "friction"});
  return {section.Get("link").Text(), ReadFriction(section), link.key()};
}

DampingConfig ReadDamping(const YamlValue& value) {
  const YamlSection section(value, {"mass_per_s", "stiffness_s"});
  DampingConfig damping;
  if (const auto mass = section.Find("mass_per_s")) damping.mass_per_s = mass->Number(NumberRange::Closed(0, 1e4));
  if (const auto stiffness = section.Find("stiffness_s")) {
    damping.stiffness_s = stiffness->Number(NumberRange::Closed(0, 10));
  }
  return damping;
}

SolverConfig ReadSolver(const YamlValue& value) {
  const YamlSection section(value, {"integrator", "relative_tolerance", "newton_iterations", "threads", "sub_steps"});
  SolverConfig solver;
  if (const auto integrator = section.Find("integrator")) {
    const std::string name = integrator->Text();
    const std::map<std::string, Integrator> integrators = {{"auto", Integrator::kAuto},
                                                           {"generalized_alpha", Integrator::kGeneralizedAlpha},
                                                           {"implicit_euler", Integrator::kImplicitEuler},
                                                           {"explicit", Integrator::kExplicit},
                                                           {"quasi_static", Integrator::kQuasiStatic}};
    const auto found = integrators.find(name);
    if (found == integrators.end()) integrator->Fail("auto, generalized_alpha, implicit_euler, explicit or quasi_static");
    solver.integrator = found->second;
  }
  if (const auto tolerance = section.Find("relative_tolerance")) {
    solver.relative_tolerance = tolerance->Number(NumberRange::Open(0, 1));
  }
  if (const auto iterations = section.Find("newton_iterations")) solver.newton_iterations = iterations->Integer(1, 100);
  if (const auto threads = section.Find("threads")) solver.threads = threads->Integer(1, 256);
  if (const auto steps = section.Find("sub_steps")) solver.sub_steps = steps->Integer(1, 1000);
  return solver;
}

}  // namespace meshless_cutting
