"""What PlanarMechanics has not, as classes inside the model: each acts between two of its frames.

A frame has x, y, phi and the flows fx, fy, t (counter-clockwise), which its component takes there: a body is pushed
with the opposite. Of its equations each class has six for these flows, and one for every variable of its own.
"""

from __future__ import annotations

_PULLED = """    frame_b.fx = -f*(frame_b.x - frame_a.x)/l;
    frame_b.fy = -f*(frame_b.y - frame_a.y)/l;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = 0;
    frame_b.t = 0;"""
_TURNED = """    frame_a.fx = 0;
    frame_a.fy = 0;
    frame_b.fx = 0;
    frame_b.fy = 0;
    frame_b.t = -tau;
    frame_a.t = tau;"""

CLASSES = {
    "LineSpring": (
        "Spring and damper between two points; f pushes them apart",
        """    parameter Real k(unit="N/m") "stiffness";
    parameter Real c(unit="N.s/m") "damping";
    parameter Real l0(unit="m") "free length";
    Real l(unit="m") "length";
    Real f(unit="N");""",
        f"""    l = sqrt((frame_b.x - frame_a.x)^2 + (frame_b.y - frame_a.y)^2);
    f = -k*(l - l0) - c*der(l);
{_PULLED}""",
    ),
    "MasslessRod": (
        "Massless rod, or actuator that imposes the distance of two points; f pushes them apart",
        """    input Real l(unit="m") "distance";
    Real f(unit="N");""",
        f"""    (frame_b.x - frame_a.x)^2 + (frame_b.y - frame_a.y)^2 = l^2;
{_PULLED}""",
    ),
    "AngleSpring": (
        "Torsion spring and damper; tau turns the second frame",
        """    parameter Real k(unit="N.m/rad") "stiffness";
    parameter Real c(unit="N.m.s/rad") "damping";
    parameter Real phi0(unit="rad") "free angle";
    Real phi(unit="rad") "angle of the second frame against the first";
    Real tau(unit="N.m");""",
        f"""    phi = frame_b.phi - frame_a.phi;
    tau = -k*(phi - phi0) - c*der(phi);
{_TURNED}""",
    ),
    "ImposedAngle": (
        "Imposes the angle of the second frame against the first; tau turns the second",
        """    input Real phi(unit="rad") "angle";
    Real tau(unit="N.m");""",
        f"""    frame_b.phi - frame_a.phi = phi;
{_TURNED}""",
    ),
    "AppliedTorque": (
        "Torque on the second frame, its opposite on the first",
        """    input Real tau(unit="N.m");""",
        _TURNED,
    ),
    "AppliedForce": (
        "Force on the second frame in a direction of the first, which feels nothing",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    input Real f(unit="N");""",
        """    frame_b.fx = -f*(cos(frame_a.phi)*ux - sin(frame_a.phi)*uy);
    frame_b.fy = -f*(sin(frame_a.phi)*ux + cos(frame_a.phi)*uy);
    frame_b.t = 0;
    frame_a.fx = 0;
    frame_a.fy = 0;
    frame_a.t = 0;""",
    ),
    "ImposedCoordinate": (
        "Imposes how far the second frame lies along a direction of the first; f pushes it there",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    input Real s(unit="m") "distance along it";
    Real ex "direction in the world";
    Real ey;
    Real f(unit="N");""",
        """    ex = cos(frame_a.phi)*ux - sin(frame_a.phi)*uy;
    ey = sin(frame_a.phi)*ux + cos(frame_a.phi)*uy;
    (frame_b.x - frame_a.x)*ex + (frame_b.y - frame_a.y)*ey = s;
    frame_b.fx = -f*ex;
    frame_b.fy = -f*ey;
    frame_b.t = 0;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = f*((frame_b.x - frame_a.x)*ey - (frame_b.y - frame_a.y)*ex);""",
    ),
    "RackAndPinion": (
        "A pinion about frame_b rolls on a rack along a direction of frame_a; f is the force of the teeth on it",
        """    parameter Real ux "direction in frame_a";
    parameter Real uy;
    parameter Real radius(unit="m") "pitch radius";
    parameter Real c(unit="m") "how it meshes";
    Real ex "direction in the world";
    Real ey;
    Real f(unit="N");""",
        """    ex = cos(frame_a.phi)*ux - sin(frame_a.phi)*uy;
    ey = sin(frame_a.phi)*ux + cos(frame_a.phi)*uy;
    (frame_b.x - frame_a.x)*ex + (frame_b.y - frame_a.y)*ey + radius*(frame_b.phi - frame_a.phi) = c;
    frame_b.fx = -f*ex;
    frame_b.fy = -f*ey;
    frame_b.t = -f*radius;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;
    frame_a.t = f*((frame_b.x - frame_a.x)*ey - (frame_b.y - frame_a.y)*ex + radius);""",
    ),
    "RollingWheels": (
        "Gears or a belt: both wheels turn against the line of their centres; f acts where they touch",
        """    parameter Real a(unit="m") "pitch radius of the first";
    parameter Real b(unit="m") "of the second, negative where both turn the same way";
    parameter Real c(unit="m") "how they mesh";
    Real gamma(unit="rad") "angle of the line of centres";
    Real d(unit="m") "distance of the centres";
    Real f(unit="N");""",
        """    frame_b.x - frame_a.x = d*cos(gamma);
    frame_b.y - frame_a.y = d*sin(gamma);
    a*(frame_a.phi - gamma) + b*(frame_b.phi - gamma) = c;
    frame_a.t = -f*a;
    frame_b.t = -f*b;
    frame_b.fx = -f*(a + b)*sin(gamma)/d;
    frame_b.fy = f*(a + b)*cos(gamma)/d;
    frame_a.fx + frame_b.fx = 0;
    frame_a.fy + frame_b.fy = 0;""",
    ),
}
"""By name: what it is, its declarations, its equations."""


def text_of(name: str) -> str:
    """The class as it stands inside the model."""
    what, declared, equations = CLASSES[name]
    return (
        f'  model {name} "{what}"\n    extends PlanarMechanics.Interfaces.PartialTwoFrames;\n'
        f"{declared}\n  equation\n{equations}\n  end {name};\n"
    )
