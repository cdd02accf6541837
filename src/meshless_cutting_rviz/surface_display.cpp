#include "surface_display.h"

#include <ros/message_traits.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>

#include <pluginlib/class_list_macros.hpp>

namespace meshless_cutting {
namespace {

enum Shape { kDeformed, kAtRest };
enum Style { kFaces, kFacesAndWires, kWires };
enum Colours { kByRegion, kByFragment };

constexpr float kStatusPeriod = 0.5f;  // s
constexpr int kTopologyQueue = 20;     // a bag that is played fast
constexpr int kPositionsQueue = 5;

template <class Message>
QString TypeName() {
  return QString::fromStdString(ros::message_traits::datatype<Message>());
}

}  // namespace

// Values are set in the constructors of the properties only: a slot that runs before onInitialize() has no Ogre.
SurfaceDisplay::SurfaceDisplay() {
  topology_topic_ =
      new rviz::RosTopicProperty("Topology Topic", "/simulator/surface/topology", TypeName<SurfaceTopology>(),
                                 "meshless_cutting/SurfaceTopology", this, SLOT(UpdateTopics()));
  positions_topic_ =
      new rviz::RosTopicProperty("Positions Topic", "/simulator/surface/positions", TypeName<SurfacePositions>(),
                                 "meshless_cutting/SurfacePositions", this, SLOT(UpdateTopics()));
  shape_ = new rviz::EnumProperty("Shape", "Deformed", "As it is now, or as it was at rest.", this, SLOT(UpdateLook()));
  shape_->addOption("Deformed", kDeformed);
  shape_->addOption("At Rest", kAtRest);
  style_ = new rviz::EnumProperty("Style", "Faces", "Faces, edges of triangles, or both.", this, SLOT(UpdateLook()));
  style_->addOption("Faces", kFaces);
  style_->addOption("Faces and Wires", kFacesAndWires);
  style_->addOption("Wires", kWires);
  colours_ = new rviz::EnumProperty("Colours", "Skin and Cut Face",
                                    "By region, or with a colour of its own for each piece that came free.", this,
                                    SLOT(UpdateLook()));
  colours_->addOption("Skin and Cut Face", kByRegion);
  colours_->addOption("Fragments", kByFragment);
  skin_colour_ =
      new rviz::ColorProperty("Skin Colour", QColor(150, 46, 38), "Of the original surface.", this, SLOT(UpdateLook()));
  cut_face_colour_ = new rviz::ColorProperty("Cut Face Colour", QColor(240, 140, 128), "Of surface that a cut made.",
                                             this, SLOT(UpdateLook()));
  wire_colour_ =
      new rviz::ColorProperty("Wire Colour", QColor(40, 20, 20), "Of edges of triangles.", this, SLOT(UpdateLook()));
  alpha_ = new rviz::FloatProperty("Alpha", 1.0f, "Below 1 the tissue is seen through.", this, SLOT(UpdateLook()));
  alpha_->setMin(0);
  alpha_->setMax(1);
}

SurfaceDisplay::~SurfaceDisplay() {
  if (initialized()) Unsubscribe();
}

void SurfaceDisplay::onInitialize() {
  visual_ = std::make_unique<SurfaceVisual>(scene_manager_, scene_node_);
  UpdateLook();
}

void SurfaceDisplay::onEnable() { Subscribe(); }

void SurfaceDisplay::onDisable() {
  Unsubscribe();
  reset();
}

void SurfaceDisplay::reset() {
  Display::reset();
  matcher_.Clear();
  if (visual_) visual_->Clear();
  changed_ = waiting_ = false;
  refused_.clear();
  received_ = 0;
  since_status_ = 0;
}

void SurfaceDisplay::setTopic(const QString& topic, const QString& datatype) {
  // The two lie side by side; one is found from the other.
  const bool topology = datatype == TypeName<SurfaceTopology>();
  const QString folder = topic.section('/', 0, -2);
  topology_topic_->setString(topology ? topic : folder + "/topology");
  positions_topic_->setString(topology ? folder + "/positions" : topic);
}

void SurfaceDisplay::UpdateTopics() {
  if (!initialized()) return;
  Unsubscribe();
  reset();
  if (isEnabled()) Subscribe();
}

void SurfaceDisplay::Subscribe() {
  if (!isEnabled()) return;
  const auto hints = ros::TransportHints().tcpNoDelay();
  try {
    topology_sub_ = update_nh_.subscribe<SurfaceTopology>(
        topology_topic_->getTopicStd(), kTopologyQueue,
        [this](const SurfaceTopologyConstPtr& topology) { Receive(topology); }, ros::VoidConstPtr(), hints);
    positions_sub_ = update_nh_.subscribe<SurfacePositions>(
        positions_topic_->getTopicStd(), kPositionsQueue,
        [this](const SurfacePositionsConstPtr& positions) { Receive(positions); }, ros::VoidConstPtr(), hints);
    setStatus(rviz::StatusProperty::Warn, "Surface", "no message yet");
  } catch (const ros::Exception& error) {
    setStatus(rviz::StatusProperty::Error, "Surface", QString("not subscribed: ") + error.what());
  }
}

void SurfaceDisplay::Unsubscribe() {
  topology_sub_.shutdown();
  positions_sub_.shutdown();
}

void SurfaceDisplay::Receive(const SurfaceTopologyConstPtr& topology) { Note(matcher_.Add(topology)); }

void SurfaceDisplay::Receive(const SurfacePositionsConstPtr& positions) {
  ++received_;
  Note(matcher_.Add(positions));
}

void SurfaceDisplay::Note(SurfaceMatcher::Outcome outcome) {
  using Outcome = SurfaceMatcher::Outcome;
  if (outcome == Outcome::kShown) {
    changed_ = true;
    waiting_ = false;
    refused_.clear();
  }
  if (outcome == Outcome::kWaiting) waiting_ = true;
  if (outcome == Outcome::kRefused) refused_ = matcher_.error();
}

void SurfaceDisplay::UpdateLook() {
  if (!visual_) return;
  SurfaceLook look;
  const int style = style_->getOptionInt();
  look.faces = style != kWires;
  look.wires = style != kFaces;
  look.at_rest = shape_->getOptionInt() == kAtRest;
  look.fragments = colours_->getOptionInt() == kByFragment;
  look.alpha = alpha_->getFloat();
  look.skin = skin_colour_->getOgreColor();
  look.cut_face = cut_face_colour_->getOgreColor();
  look.wire = wire_colour_->getOgreColor();
  visual_->SetLook(look);
  context_->queueRender();
}

// Only the newest surface is drawn: frames that came in while rviz drew the last one cost nothing.
void SurfaceDisplay::update(float wall_dt, float) {
  if (changed_) {
    const MatchedSurface& surface = matcher_.surface();
    visual_->SetSurface(surface.topology, surface.positions);
    changed_ = false;
    context_->queueRender();
  }
  if (matcher_.surface().positions && !PlaceInFixedFrame()) visual_->Clear(), changed_ = true;
  ShowStatus(wall_dt);
}

bool SurfaceDisplay::PlaceInFixedFrame() {
  const std::string& frame = matcher_.surface().positions->header.frame_id;
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  // The newest transform: the stamps of a bag are not those of tf when rviz was started without simulated time.
  if (!context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation)) {
    setStatus(rviz::StatusProperty::Error, "Transform",
              QString("no transform from [%1] to the fixed frame [%2]").arg(frame.c_str(), fixed_frame_));
    return false;
  }
  setStatus(rviz::StatusProperty::Ok, "Transform", "Transform OK");
  visual_->SetPose(position, orientation);
  return true;
}

void SurfaceDisplay::ShowStatus(float wall_dt) {
  since_status_ += wall_dt;
  if (since_status_ < kStatusPeriod) return;
  const double rate = received_ / static_cast<double>(since_status_);
  received_ = 0;
  since_status_ = 0;
  if (!refused_.empty()) {
    setStatus(rviz::StatusProperty::Error, "Surface", QString("refused: ") + refused_.c_str());
    refused_.clear();
    return;
  }
  const MatchedSurface& surface = matcher_.surface();
  if (!surface.positions) {
    setStatus(rviz::StatusProperty::Warn, "Surface",
              waiting_ ? "positions wait for their topology, which comes once a second" : "no message yet");
    return;
  }
  const double age = (ros::Time::now() - surface.positions->header.stamp).toSec();
  const QString text = QString("session %1, version %2, %3 triangles, %4 Hz, age %5 s")
                           .arg(surface.positions->session)
                           .arg(surface.positions->version)
                           .arg(surface.topology->triangles.size() / 3)
                           .arg(rate, 0, 'f', 1)
                           .arg(age, 0, 'f', 3);
  if (waiting_) {
    setStatus(rviz::StatusProperty::Warn, "Surface", text + "; newer positions wait for their topology");
  } else if (rate == 0) {
    setStatus(rviz::StatusProperty::Warn, "Surface", text + "; no positions come in: paused, or the bag has ended");
  } else {
    setStatus(rviz::StatusProperty::Ok, "Surface", text);
  }
}

}  // namespace meshless_cutting

PLUGINLIB_EXPORT_CLASS(meshless_cutting::SurfaceDisplay, rviz::Display)
