#pragma once

/// Three kinds of machine as tables: parts with typical values, the joints between them, the heat they make.

#include <string>
#include <vector>

namespace blind {

struct Part {
  std::string name, group;
  double capacity_J_per_K, ambient_W_per_K, um_per_K;
  double present = 1;  ///< probability that this machine has it
};

struct Joint {
  std::string a, b;
  double W_per_K;
};

struct Heat {
  std::string name, input;
  double exponent, power_W;
  std::vector<std::pair<std::string, double>> into;
};

struct Kind {
  std::string name;
  std::vector<Part> parts;
  std::vector<Joint> joints;
  std::vector<Heat> heats;
  double top_speed_rpm;
  bool feeds;
};

inline std::vector<Kind> kinds() {
  return {{"machining centre",
           {{"shaft_nose", "shaft", 1200, .3, .8},
            {"shaft_front", "shaft", 1500, .35, .7},
            {"shaft_rear", "shaft", 5500, 1.4, .1},
            {"head_tip", "head", 11500, 1.8, .4, .7},
            {"head_front", "head", 12500, 3.2, .8},
            {"head_centre", "head", 14000, 2.4, 1.9},
            {"head_back", "head", 13000, 2.6, .4},
            {"flange", "drive", 6200, 2.0, 0, .8},
            {"motor", "drive", 6800, 2.6, 0},
            {"column_front_low", "column", 66000, 3.5, .2, .8},
            {"column_front_high", "column", 82000, 4.0, .1},
            {"column_rear_low", "column", 55000, 4.2, -2.8, .8},
            {"column_rear_high", "column", 60000, 4.0, -1.6},
            {"nut", "feed", 2800, .55, .2},
            {"screw", "feed", 5800, .8, 0},
            {"bed", "base", 650000, 15, .2},
            {"table", "base", 60000, 4, -.6, .4},
            {"cabinet", "column", 24000, 3, 0, .3}},
           {{"shaft_nose", "shaft_front", 2.2},
            {"shaft_front", "shaft_rear", .8},
            {"shaft_front", "head_front", 9},
            {"shaft_rear", "head_back", .9},
            {"shaft_rear", "flange", .7},
            {"shaft_rear", "motor", .5},
            {"head_tip", "head_front", 35},
            {"head_front", "head_centre", 18},
            {"head_centre", "head_back", 7},
            {"head_centre", "column_front_high", 28},
            {"head_back", "flange", 3},
            {"head_back", "nut", 1.6},
            {"flange", "motor", 15},
            {"head_back", "motor", 1.5},
            {"column_front_low", "column_front_high", 8},
            {"column_front_low", "column_rear_low", 5},
            {"column_front_high", "column_rear_high", 8},
            {"column_rear_low", "column_rear_high", 6},
            {"column_front_low", "bed", 7.5},
            {"column_rear_low", "bed", 8},
            {"column_front_high", "bed", 4},
            {"column_front_high", "screw", 1.8},
            {"nut", "screw", 3.5},
            {"bed", "table", 12},
            {"column_rear_high", "cabinet", 4}},
           {{"front bearings", "spindle_rpm", 1.2, 150, {{"shaft_front", .5}, {"head_front", .5}}},
            {"rear bearings", "spindle_rpm", 1.2, 35, {{"shaft_rear", .5}, {"head_back", .5}}},
            {"motor", "spindle_rpm", 1.0, 75, {{"motor", 1}}},
            {"feed drive", "feed_mm_min", 1.0, 40, {{"nut", .7}, {"screw", .3}}}},
           6000,
           true},
          {"lathe",
           {{"chuck", "spindle", 9000, 2.2, .7, .8},
            {"spindle_front", "spindle", 4500, .5, .8},
            {"spindle_rear", "spindle", 4200, .9, .2},
            {"headstock_front", "headstock", 23000, 3.2, 1.1},
            {"headstock_rear", "headstock", 21000, 3.4, .5},
            {"headstock_foot", "headstock", 34000, 2.6, .9, .8},
            {"gearbox", "headstock", 26000, 3.8, .2, .5},
            {"motor", "drive", 15000, 5.5, 0},
            {"bed_left", "bed", 120000, 6.5, -1.3},
            {"bed_middle", "bed", 150000, 7.5, -1.1},
            {"bed_right", "bed", 125000, 6.5, -.2, .7},
            {"saddle", "carriage", 31000, 2.8, .7},
            {"turret", "carriage", 25000, 3.3, .8, .8},
            {"nut", "feed", 2600, .5, .1},
            {"screw", "feed", 7000, 1.0, .1}},
           {{"chuck", "spindle_front", 5},
            {"spindle_front", "spindle_rear", 2},
            {"spindle_front", "headstock_front", 14},
            {"spindle_rear", "headstock_rear", 9},
            {"headstock_front", "headstock_rear", 16},
            {"headstock_front", "headstock_foot", 20},
            {"headstock_rear", "headstock_foot", 14},
            {"headstock_rear", "gearbox", 9},
            {"headstock_foot", "bed_left", 22},
            {"headstock_front", "bed_left", 8},
            {"motor", "bed_left", 4},
            {"motor", "gearbox", 1.2},
            {"bed_left", "bed_middle", 16},
            {"bed_middle", "bed_right", 15},
            {"bed_middle", "saddle", 6},
            {"saddle", "turret", 9},
            {"saddle", "nut", 1.5},
            {"nut", "screw", 3},
            {"screw", "bed_middle", 1.2}},
           {{"front bearings", "spindle_rpm", 1.3, 170, {{"spindle_front", .45}, {"headstock_front", .55}}},
            {"rear bearings", "spindle_rpm", 1.3, 90, {{"spindle_rear", .45}, {"headstock_rear", .55}}},
            {"motor", "spindle_rpm", 1.0, 140, {{"motor", 1}}},
            {"feed drive", "feed_mm_min", 1.0, 45, {{"nut", .65}, {"screw", .35}}}},
           4000,
           true},
          {"spindle unit",
           {{"holder", "shaft", 700, .35, .6, .7},
            {"shaft_front", "shaft", 1700, .3, .7},
            {"shaft_middle", "shaft", 2600, .35, .4, .6},
            {"shaft_rear", "shaft", 1800, .5, .1},
            {"housing_front", "housing", 6200, 1.7, .9},
            {"housing_middle", "housing", 8000, 1.7, .6},
            {"housing_rear", "housing", 6000, 1.5, .2},
            {"stator", "drive", 8500, 1.3, 0},
            {"rotor", "drive", 3600, .4, .15},
            {"flange", "mount", 11000, 2.2, .4},
            {"bracket", "mount", 32000, 4.2, -.9},
            {"base", "mount", 90000, 7, .8},
            {"oil_unit", "mount", 9000, 2.5, 0, .4}},
           {{"holder", "shaft_front", 2},
            {"shaft_front", "shaft_middle", 2.4},
            {"shaft_middle", "shaft_rear", 2.4},
            {"shaft_front", "shaft_rear", .8},
            {"shaft_front", "housing_front", 8},
            {"shaft_rear", "housing_rear", 6},
            {"rotor", "shaft_middle", 6},
            {"rotor", "shaft_rear", 3},
            {"stator", "housing_middle", 14},
            {"housing_front", "housing_middle", 16},
            {"housing_middle", "housing_rear", 15},
            {"housing_front", "flange", 20},
            {"flange", "bracket", 18},
            {"bracket", "base", 14},
            {"oil_unit", "base", 3}},
           {{"front bearings", "spindle_rpm", 1.25, 70, {{"shaft_front", .5}, {"housing_front", .5}}},
            {"rear bearings", "spindle_rpm", 1.25, 40, {{"shaft_rear", .5}, {"housing_rear", .5}}},
            {"motor", "spindle_rpm", 1.1, 60, {{"stator", .7}, {"rotor", .3}}}},
           18000,
           false}};
}

}  // namespace blind
