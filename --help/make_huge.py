import sys,struct
import numpy as np
out=sys.argv[1]; sub=int(sys.argv[2]) if len(sys.argv)>2 else 9
t=(1+5**.5)/2
V=np.array([(-1,t,0),(1,t,0),(-1,-t,0),(1,-t,0),(0,-1,t),(0,1,t),(0,-1,-t),(0,1,-t),(t,0,-1),(t,0,1),(-t,0,-1),(-t,0,1)],float)
F=np.array([(0,11,5),(0,5,1),(0,1,7),(0,7,10),(0,10,11),(1,5,9),(5,11,4),(11,10,2),(10,7,6),(7,1,8),(3,9,4),(3,4,2),(3,2,6),(3,6,8),(3,8,9),(4,9,5),(2,4,11),(6,2,10),(8,6,7),(9,8,1)])
T=V[F]; T/=np.linalg.norm(T,axis=2,keepdims=True)
for _ in range(sub):
    a,b,c=T[:,0],T[:,1],T[:,2]; m=lambda p,q:(p+q)/np.linalg.norm(p+q,axis=1,keepdims=True)
    ab,bc,ca=m(a,b),m(b,c),m(c,a); T=np.concatenate([np.stack(x,1) for x in((a,ab,ca),(ab,b,bc),(ca,bc,c),(ab,bc,ca))])
r=1+0.1*np.sin(7*T[...,0])*np.cos(5*T[...,1])+0.03*np.sin(40*T[...,2]); T=T*r[...,None]*np.array([1,.8,.6])
d=np.zeros(len(T),dtype=np.dtype([('n','<f4',3),('v','<f4',(3,3)),('a','<u2')])); d['v']=T
open(out,'wb').write(b'huge'.ljust(80,b' ')+struct.pack('<I',len(T))); open(out,'ab').write(d.tobytes()); print(len(T),'triangles')
