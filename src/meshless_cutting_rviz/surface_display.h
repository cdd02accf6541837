// The surface of a soft object in rviz: properties, subscriptions, tf and the status line.
#pragma once

#ifndef Q_MOC_RUN
#include <meshless_cutting/SurfacePositions.h>
#include <meshless_cutting/SurfaceTopology.h>
#include <ros/ros.h>
#include <rviz/display.h>

#include <memory>

#include "surface_matcher.h"
#include "surface_visual.h"
#endif

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
}  // namespace rviz

namespace meshless_cutting {

class SurfaceDisplay : public rviz::Display {
  Q_OBJECT

 public:
  SurfaceDisplay();
  ~SurfaceDisplay() override;

  void reset() override;
  void update(float wall_dt, float ros_dt) override;
  void setTopic(const QString& topic, const QString& datatype) override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void UpdateTopics();
  void UpdateLook();

 private:
  void Subscribe();
  void Unsubscribe();
  void Receive(const SurfaceTopologyConstPtr& topology);
  void Receive(const SurfacePositionsConstPtr& positions);
  void Note(SurfaceMatcher::Outcome outcome);
  bool PlaceInFixedFrame();
  void ShowStatus(float wall_dt);

  rviz::RosTopicProperty* topology_topic_;
  rviz::RosTopicProperty* positions_topic_;
  rviz::EnumProperty* shape_;
  rviz::EnumProperty* style_;
  rviz::EnumProperty* colours_;
  rviz::ColorProperty* skin_colour_;
  rviz::ColorProperty* cut_face_colour_;
  rviz::ColorProperty* wire_colour_;
  rviz::FloatProperty* alpha_;

  ros::Subscriber topology_sub_, positions_sub_;
  SurfaceMatcher matcher_;
  std::unique_ptr<SurfaceVisual> visual_;
  bool changed_ = false;    // matcher_ has a surface that is not drawn yet
  bool waiting_ = false;    // for a topology
  std::string refused_;     // what was wrong with the last message
  int received_ = 0;        // positions since the status line was written
  float since_status_ = 0;  // s
};

}  // namespace meshless_cutting
