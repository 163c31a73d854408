// Reads a course of commands and answers each `tell` with offset, state, fault and status of the C++ or the C export,
// whichever it is compiled for: `fault_course < course`. One line a command:
//   start | resume | stop | datum | power KIND | step PERIODS BEAT READING READING READING | tell
// `power` switches off and keeps what is retained: whole, none (never stored), cut (one value changed) or foreign.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#ifdef COURSE_IN_C
extern "C" {
#include "course.h"
}
struct Device {
  course_compensator self;
  course_retained kept{};
  double offset[COURSE_ERRORS] = {};
  std::uint32_t status = 0;
  Device() { course_initialise(&self); }
  void start() { course_start(&self, nullptr); }
  void resume() { course_resume(&self, &kept, nullptr); }
  void stop() { course_stop(&self); }
  void datum() { course_datum(&self); }
  void power() {
    course_retain(&self, &kept);
    course_initialise(&self);
    offset[1] = 0;
  }
  void step(std::uint32_t periods, std::uint32_t beat, const double* readings) {
    status = course_step_after(&self, readings, periods, beat, offset);
  }
  double z() const { return offset[1]; }
};
#else
#include "course.hpp"
struct Device {
  course::Compensator* self = new course::Compensator(course::model, course::settings);
  course::Compensator::Retained kept{};
  std::uint32_t status = 0;
  void start() { self->start(); }
  void resume() { self->resume(kept); }
  void stop() { self->stop(); }
  void datum() { self->take_datum(); }
  void power() {
    kept = self->retained();
    delete self;
    self = new course::Compensator(course::model, course::settings);
  }
  void step(std::uint32_t periods, std::uint32_t beat, const double* readings) {
    status = self->step({readings[0], readings[1], readings[2]}, {periods, beat}).word;
  }
  double z() const { return self->offset_um()[1]; }
};
#endif

int main() {
  Device device;
  for (std::string line, word; std::getline(std::cin, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "start") device.start();
    if (word == "resume") device.resume();
    if (word == "stop") device.stop();
    if (word == "datum") device.datum();
    if (word == "power") {
      device.power();
      words >> word;
      if (word == "none") device.kept = {};
      if (word == "cut") device.kept.zero_degC[0] += 5;
      if (word == "foreign") device.kept.model += 1;
    }
    if (word == "step") {
      std::uint32_t periods = 0, beat = 0;
      std::string text[3];
      words >> periods >> beat >> text[0] >> text[1] >> text[2];
      double readings[3];
      for (int i = 0; i < 3; ++i) readings[i] = text[i] == "-" ? std::nan("") : std::stod(text[i]);
      device.step(periods, beat, readings);
    }
    if (word == "tell") std::printf("%.9g %u\n", device.z() + 0., device.status);
  }
}
