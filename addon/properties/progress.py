"""Long work that runs now: what operators/long.py tells the panels and the polls of others."""

from bpy.props import FloatProperty, StringProperty


class WorkProgress:
    running: StringProperty(description="What runs (“Cutting”); empty where nothing does")
    simulating: StringProperty(description="The program that is simulated; empty where none is")
    shading: StringProperty(description="How views were shaded before they showed colours of distances")
    percent: FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100, precision=0)
    notice: StringProperty(description="What happened to a sculpt that nobody asked for; empty where all is well")
    text: StringProperty(description="How far it is, in its own words")
