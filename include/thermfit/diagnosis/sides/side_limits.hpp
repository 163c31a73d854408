#pragma once

/// When a difference between the sides is one of how they were written down.

namespace thermfit {

/// When a difference between the sides is one of how they were written down.
struct SideLimits {
  double certain_nats = 10;       ///< of log probability over everything else within belief: certain
  double suspected_nats = 4;      ///< suspected
  double level_K = 12;            ///< temperatures that agree better than this are in one unit
  double unit_within = 2.2;       ///< a factor between the sides is that of a unit where it is so near to it …
  double beyond_belief = 5;       ///< … and no miscalibration where it is beyond this
  double least_correlation = .6;  ///< of displacements that are the same but for unit or sign
  double exchanged = .9;          ///< exchanged columns must lower the misfit of both together to this share
  double plain = .5;              ///< where they lower it to this share before any calibration, that counts by itself
  double exchanged_room = .5;     ///< with the room among them: the misfit of every channel, on the average
  double copied = .5;             ///< a simulator that shows two columns alike which differ by this share of their rise
  double relative_sd = .3;        ///< what a prior standard deviation is of a number of the simulator
  double drive_leaves = .35;  ///< another clock or room must explain the channels but for this share of their course
  double late = .67;          ///< a clock that is off must lower the misfit to this share
  double datum_noises = 12;   ///< a displacement that starts as many standard deviations of a reading off the …
  double datum_share = .1;    ///< … other side, and off it by this share of its swing, counts from another zero
  double room_degC = 20;      ///< rooms are as warm as that …
  double room_sd_K = 10;      ///< … within this standard deviation …
  double warmest_start_degC = 45;  ///< … and no warmer
};

}  // namespace thermfit
