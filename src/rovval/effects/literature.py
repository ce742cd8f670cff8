"""The literature that effects cite: the short name that stands in an effect's file, and the full reference."""

from __future__ import annotations

import re
from types import MappingProxyType

REFERENCES = MappingProxyType(
    {
        "ABS 2013": "American Bureau of Shipping (2013). Guide for Dynamic Positioning Systems.",
        "Alessandri 1999": "Alessandri, A., Caccia, M. and Veruggio, G. (1999). Fault detection of actuator faults in unmanned underwater vehicles. "
        "Control Engineering Practice 7(3).",
        "Armstrong-Helouvry 1994": "Armstrong-Helouvry, B., Dupont, P. and Canudas de Wit, C. (1994). A survey of models, analysis tools and compensation "
        "methods for the control of machines with friction. Automatica 30(7).",
        "Auton 1988": "Auton, T. R., Hunt, J. C. R. and Prud'homme, M. (1988). The force exerted on a body in inviscid unsteady non-uniform rotational flow. "
        "Journal of Fluid Mechanics 197.",
        "Bachmayer 2000": "Bachmayer, R., Whitcomb, L. L. and Grosenbaugh, M. A. (2000). An accurate four-quadrant nonlinear dynamical model for marine "
        "thrusters: theory and experimental validation. IEEE Journal of Oceanic Engineering 25(1).",
        "Bessa 2006": "Bessa, W. M., Dutra, M. S. and Kreuzer, E. (2006). Thruster dynamics compensation for the positioning of underwater robotic vehicles "
        "through a fuzzy sliding mode based approach. ABCM Symposium Series in Mechatronics 2.",
        "Bhattacharyya 2016": "Bhattacharyya, S., Reyes, A. J. and Asada, H. H. (2016). Dynamical modeling of a micro AUV in hydrodynamic ground effect. "
        "OCEANS 2016 MTS/IEEE Monterey. doi:10.1109/OCEANS.2016.7761326.",
        "Biran 2003": "Biran, A. (2003). Ship Hydrostatics and Stability. Butterworth-Heinemann.",
        "Blue Robotics T200": "Blue Robotics. T200 thruster: technical details and performance tables.",
        "Buckham 2004": "Buckham, B., Driscoll, F. R. and Nahon, M. (2004). Development of a finite element cable model for use in low-tension dynamics "
        "simulation. Journal of Applied Mechanics 71(4).",
        "Caccia 2000": "Caccia, M., Indiveri, G. and Veruggio, G. (2000). Modeling and identification of open-frame variable configuration unmanned underwater "
        "vehicles. IEEE Journal of Oceanic Engineering 25(2).",
        "Carlton 2018": "Carlton, J. (2018). Marine Propellers and Propulsion, 4th edition. Butterworth-Heinemann.",
        "Dang and Laheij 2004": "Dang, J. and Laheij, H. (2004). Hydrodynamic aspects of steerable thrusters. MTS Dynamic Positioning Conference, Houston.",
        "DNV 2010": "Det Norske Veritas (2010). DNV-RP-C205: Environmental Conditions and Environmental Loads.",
        "DNV 2011": "Det Norske Veritas (2011). DNV-RP-H103: Modelling and Analysis of Marine Operations.",
        "Driscoll 2000": "Driscoll, F. R., Lueck, R. G. and Nahon, M. (2000). Development and validation of a lumped-mass dynamics model of a deep-sea ROV "
        "system. Applied Ocean Research 22(3).",
        "Eidsvik 2015": "Eidsvik, O. A. (2015). Identification of Hydrodynamic Parameters for Remotely Operated Vehicles. Master's thesis, NTNU.",
        "Eustice 2011": "Eustice, R. M., Singh, H. and Whitcomb, L. L. (2011). Synchronous-clock, one-way-travel-time acoustic navigation for underwater "
        "vehicles. Journal of Field Robotics 28(1).",
        "Faltinsen 1990": "Faltinsen, O. M. (1990). Sea Loads on Ships and Offshore Structures. Cambridge University Press.",
        "Feng and Allen 2004": "Feng, Z. and Allen, R. (2004). Evaluation of the effects of the communication cable on the dynamics of an underwater flight "
        "vehicle. Ocean Engineering 31.",
        "Fofonoff and Millard 1983": "Fofonoff, N. P. and Millard, R. C. (1983). Algorithms for computation of fundamental properties of seawater. UNESCO "
        "Technical Papers in Marine Science 44.",
        "Fossen 2021": "Fossen, T. I. (2021). Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd edition. Wiley.",
        "Fossen and Johansen 2006": "Fossen, T. I. and Johansen, T. A. (2006). A survey of control allocation methods for ships and underwater vehicles. 14th "
        "Mediterranean Conference on Control and Automation.",
        "Furgale 2013": "Furgale, P., Rehder, J. and Siegwart, R. (2013). Unified temporal and spatial calibration for multi-sensor systems. IEEE/RSJ "
        "International Conference on Intelligent Robots and Systems.",
        "Gebre-Egziabher 2006": "Gebre-Egziabher, D., Elkaim, G. H., Powell, J. D. and Parkinson, B. W. (2006). Calibration of strapdown magnetometers in "
        "magnetic field domain. Journal of Aerospace Engineering 19(2).",
        "Gertler and Hagen 1967": "Gertler, M. and Hagen, G. R. (1967). Standard equations of motion for submarine simulation. Naval Ship Research and "
        "Development Center, report 2510.",
        "Gill 1982": "Gill, A. E. (1982). Atmosphere-Ocean Dynamics. Academic Press.",
        "Gracey 1980": "Gracey, W. (1980). Measurement of aircraft speed and altitude. NASA Reference Publication 1046.",
        "Groves 2013": "Groves, P. D. (2013). Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2nd edition. Artech House.",
        "Healey 1995": "Healey, A. J., Rock, S. M., Cody, S., Miles, D. and Brown, J. P. (1995). Toward an improved understanding of thruster dynamics for "
        "underwater vehicles. IEEE Journal of Oceanic Engineering 20(4).",
        "Hoerner 1965": "Hoerner, S. F. (1965). Fluid-Dynamic Drag. Published by the author.",
        "Hoerner and Borst 1975": "Hoerner, S. F. and Borst, H. V. (1975). Fluid-Dynamic Lift. Hoerner Fluid Dynamics.",
        "JMSE 2025": "Hydrodynamic calculation and analysis of a complex-shaped ROV moving near the wall based on CFDs (2025). Journal of Marine Science and "
        "Engineering 13(6), 1183. doi:10.3390/jmse13061183.",
        "Joyce 1989": "Joyce, T. M. (1989). On in situ calibration of shipboard ADCPs. Journal of Atmospheric and Oceanic Technology 6(1).",
        "Kim and Chung 2006": "Kim, J. and Chung, W. K. (2006). Accurate and practical thruster modeling for underwater vehicles. Ocean Engineering 33.",
        "Kinsey and Whitcomb 2007": "Kinsey, J. C. and Whitcomb, L. L. (2007). In situ alignment calibration of attitude and Doppler sensors for precision "
        "underwater vehicle navigation: theory and experiment. IEEE Journal of Oceanic Engineering 32(2).",
        "Klein and Morelli 2006": "Klein, V. and Morelli, E. A. (2006). Aircraft System Identification: Theory and Practice. AIAA.",
        "Knapp and Carter 1976": "Knapp, C. H. and Carter, G. C. (1976). The generalized correlation method for estimation of time delay. IEEE Transactions on "
        "Acoustics, Speech, and Signal Processing 24(4).",
        "Kozlowska 2020": "Kozlowska, A. M., Dalheim, O. O., Savio, L. and Steen, S. (2020). Time domain modeling of propeller forces due to ventilation in "
        "static and dynamic conditions. Journal of Marine Science and Engineering 8(1), 31.",
        "Lehn 1980": "Lehn, E. (1980). Thruster Interaction Effects. Norwegian Ship Research Institute (NSFI), report R-102.80.",
        "Longuet-Higgins 1984": "Longuet-Higgins, M. S. (1984). Statistical properties of wave groups in a random sea state. Philosophical Transactions of the "
        "Royal Society A 312.",
        "Martin and Whitcomb 2014": "Martin, S. C. and Whitcomb, L. L. (2014). Experimental identification of six-degree-of-freedom coupled dynamic plant "
        "models for underwater robot vehicles. IEEE Journal of Oceanic Engineering 39(4).",
        "McLain and Rock 1992": "McLain, T. W. and Rock, S. M. (1992). Experimental measurement of ROV tether tension. Proceedings of ROV '92.",
        "Newman 1977": "Newman, J. N. (1977). Marine Hydrodynamics. MIT Press.",
        "NGA 2004": "National Geospatial-Intelligence Agency (2004). Handbook of Magnetic Compass Adjustment.",
        "Nienhuis 1992": "Nienhuis, U. (1992). Analysis of Thruster Effectivity for Dynamic Positioning and Low Speed Manoeuvring. PhD thesis, TU Delft.",
        "Omerdic and Roberts 2004": "Omerdic, E. and Roberts, G. (2004). Thruster fault diagnosis and accommodation for open-frame underwater vehicles. "
        "Control Engineering Practice 12(12).",
        "Pugh and Woodworth 2014": "Pugh, D. and Woodworth, P. (2014). Sea-Level Science: Understanding Tides, Surges, Tsunamis and Mean Sea-Level Changes. "
        "Cambridge University Press.",
        "Saunders and Nahon 2002": "Saunders, A. and Nahon, M. (2002). The effect of forward vehicle velocity on through-body AUV tunnel thruster performance. "
        "OCEANS 2002 MTS/IEEE.",
        "Soule and Miller 1933": "Soule, H. A. and Miller, M. P. (1933). The Experimental Determination of the Moments of Inertia of Airplanes. NACA "
        "Report 467.",
        "thesis": "The master's thesis that rovval grew out of, which compares simulations of the Merlin UCV with its logs.",
        "Titterton and Weston 2004": "Titterton, D. H. and Weston, J. L. (2004). Strapdown Inertial Navigation Technology, 2nd edition. IEE.",
        "Tremblay and Dessaint 2009": "Tremblay, O. and Dessaint, L.-A. (2009). Experimental validation of a battery dynamic model for EV applications. World "
        "Electric Vehicle Journal 3(2).",
        "von Benzon 2022": "von Benzon, M., Sorensen, F. F., Uth, E., Jouffroy, J., Liniger, J. and Pedersen, S. (2022). An open-source benchmark simulator: "
        "control of a BlueROV2 underwater robot. Journal of Marine Science and Engineering 10(12), 1898.",
        "Wu 2018": "Wu, C.-J. (2018). 6-DoF Modelling and Control of a Remotely Operated Vehicle. Master's thesis, Flinders University.",
        "Xsens MTi": "Xsens. MTi series: data sheets of attitude and heading reference systems.",
        "Yoerger 1990": "Yoerger, D. R., Cooke, J. G. and Slotine, J.-J. E. (1990). The influence of thruster dynamics on underwater vehicle behavior and "
        "their incorporation into control system design. IEEE Journal of Oceanic Engineering 15(3).",
        "Zhao 2014": "Zhao, B., Skjetne, R., Blanke, M. and Dukan, F. (2014). Particle filter for fault diagnosis and robust navigation of underwater robot. "
        "IEEE Transactions on Control Systems Technology 22(6).",
        "Ziegler and Nichols 1942": "Ziegler, J. G. and Nichols, N. B. (1942). Optimum settings for automatic controllers. Transactions of the ASME 64.",
    }
)


def key(cited: str) -> str:
    """``Fossen 2021`` of ``Fossen 2021, section 6.4: viscous damping``."""
    return re.split(r"[:,]", cited, maxsplit=1)[0]
