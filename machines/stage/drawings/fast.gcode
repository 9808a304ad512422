; As fast as the stage is: a hatched field, a zigzag, small circles, each at 60 mm/s.
G21 G90 G17
F3600
G0 X20 Y20
G1 X100             ; hatch
Y22
X20
Y24
X100
Y26
X20
Y28
X100
G0 X20 Y45
G1 X30 Y60          ; zigzag
X40 Y45
X50 Y60
X60 Y45
X70 Y60
X80 Y45
G0 X35 Y80
G3 I-5 J0           ; circles
G3 I-5 J0
G0 X60 Y80
G2 I-10 J0
G0 X20 Y20
M30
