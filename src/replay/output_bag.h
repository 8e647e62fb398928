// A bag that is written: beside its place, as FILE.active or, where that is there, FILE.active2 and
// so on, until it is whole. Messages are written with their own stamps, so that the same messages
// are the same bytes.
#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>

#include <memory>
#include <string>

namespace robot_tissue {

class OutputBag {
 public:
  // Throws InputError.
  explicit OutputBag(const std::string& path);
  // Without commit() nothing is left.
  ~OutputBag();
  OutputBag(const OutputBag&) = delete;
  OutputBag& operator=(const OutputBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    try {
      bag_->write(topic, stamp, message);
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
  void commit();

 private:
  void makePart();
  void leaveBag();
  [[noreturn]] void refuse(const std::string& why) const;

  std::string path_, part_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
};

}  // namespace robot_tissue
