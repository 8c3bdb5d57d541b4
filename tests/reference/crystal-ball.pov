#version 3.7;
// scenes/crystal-ball.json for POV-Ray 3.7, an independent oracle. The eye is Declare=EX=..., EY, EZ.
// Here a point light's illuminance at distance d is 2 / (1 + (d / fade_distance)^fade_power) of its colour.
global_settings { assumed_gamma 1 max_trace_level 6 ambient_light rgb 1 adc_bailout 1/1000 }
#declare Background = <.42, .50, .58>;
#declare Ambient = .3;
#declare Reference = <0, -3, -11>;
#ifndef (EX) #declare EX = 0; #end
#ifndef (EY) #declare EY = 0; #end
#ifndef (EZ) #declare EZ = 0; #end

background { rgb Background }
camera {
  location <EX, EY, EZ>
  right -x*4/3  // a right-handed world
  up y
  sky y
  angle 2*degrees(atan2(tan(radians(30))*4/3, 1))  // of the width; 60 degrees high
  look_at <-.25, -1, -10>
}

#declare Key = <-30, 100, 30>;
#declare Fill = <40, 60, -15>;
#declare Back = <0, 50, -30>;
light_source { Key rgb <1, 1, .9>*1.0*(pow(vlength(Key-Reference), 2)/2) fade_distance 1 fade_power 2 }
light_source { Fill rgb <.6, .7, 1>*0.3*(vlength(Fill-Reference)/(2*.001)) fade_distance .001 fade_power 1 }
light_source { Back rgb <.3, .3, .4>*(1.1/12) }

#declare Matte = finish { ambient rgb Background*Ambient diffuse .8 specular .2 roughness 1/25 }
sphere { <-1, 0, -12>, 2 pigment { rgb <.890, .259, .204> } finish { Matte } }
sphere {
  <.5, -.5, -8>, 1.5
  pigment { rgbt 1 }
  finish { ambient 0 diffuse 0 specular .5 roughness 1/200 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
}
// Glass casts an opaque shadow: this core is seen by shadow rays alone.
sphere { <.5, -.5, -8>, 1.4999 no_image no_reflection pigment { rgb 0 } }
union {
  triangle { <-5, -3, -6>, <5, -3, -6>, <-5, -3, -16> }
  triangle { <5, -3, -6>, <5, -3, -16>, <-5, -3, -16> }
  texture {
    pigment { checker rgb <.815, .235, .031> rgb <.937, .937, .231> translate <0, .5, 0> }
    finish { Matte }
  }
}
