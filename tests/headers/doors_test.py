"""doors_test.py SOURCE: thermfit.hpp goes through the door of every topic and reaches every public header.

Public is what stands neither in impl/ nor in io/, which needs nlohmann-json. No room includes a door.
"""
from tree import DOORS, INCLUDE, finish, headers, includes, reached

doors = {f"thermfit/{door}.hpp" for door in DOORS}
wrong = [f"{door} is missing" for door in sorted(doors - set(headers()))]
whole = INCLUDE / "thermfit/thermfit.hpp"
wrong += [f"thermfit.hpp does not include {door}" for door in sorted(doors - {"thermfit/thermfit.hpp"} - set(includes(whole)))]
union = reached(whole)
public = [name for name in headers() if "/impl/" not in name and not name.startswith("thermfit/io/")]
wrong += [f"{name} is reached through no door" for name in public if name not in union and name not in doors
          and name != "thermfit/compiled.hpp"]  # not in use yet
wrong += [f"{name} includes the door {door}" for name in headers() if name not in doors
          for door in includes(INCLUDE / name) if door in doors]
wrong += [f"{name} is reached through a door" for name in union if name.startswith("thermfit/io/")]
wrong += [f"{name} includes {other}, which is not there" for name in headers() for other in includes(INCLUDE / name)
          if other.startswith("thermfit/") and not (INCLUDE / other).is_file()]
finish(wrong, f"{len(public)} public headers are reached")
