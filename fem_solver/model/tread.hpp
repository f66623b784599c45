// The running surface of a wheel across the track.
#pragma once

namespace fem {

enum class TreadKind { s1002, cone_1_20, cone_1_40 };

/// Wheel profile from the flange's back (`tread_back`) to the outer face (`tread_front`). The abscissa s runs across
/// from the running circle, positive away from the flange.
constexpr double tread_back = -0.070, tread_front = 0.060;  // [m]

/// Radius at s minus the radius of the running circle [m]. S1002: the sections A to H of EN 13715 (UIC 510-2). Cones:
/// the stated slope from -26 mm outwards, the flange of S1002, and a straight line between them.
double tread_height(TreadKind kind, double s);

/// Second derivative of tread_height() at s [1/m]; positive where the profile is hollow.
double tread_curvature(TreadKind kind, double s);

}  // namespace fem
